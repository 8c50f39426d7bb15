"""Runs the console command as ``python -m meshwright``, which is how ``torchrun`` starts it."""

import sys

from meshwright.cli import main

if __name__ == "__main__":
    sys.exit(main())
