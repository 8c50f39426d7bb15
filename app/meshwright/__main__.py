"""``python -m app``: the console command without its script, as ``torchrun`` starts it."""

import sys

from meshwright.cli import main

if __name__ == "__main__":
    sys.exit(main())
