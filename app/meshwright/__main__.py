"""The console command, also as ``python -m meshwright``, which is how ``torchrun`` starts it."""

import gc
import sys


def main() -> int:
    """Run the command line; Ctrl-C during its imports ends in one line as well.

    The objects that are left are not searched for reference cycles once more on the way out, which
    takes a third of a second after PyTorch was imported.
    """
    try:
        from meshwright import cli

        return cli.main()
    except KeyboardInterrupt:
        sys.stderr.write("meshwright: stopped by Ctrl-C; no file is half written\n")
        return 2
    finally:
        gc.freeze()


if __name__ == "__main__":
    sys.exit(main())
