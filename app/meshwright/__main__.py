"""The console command, also as ``python -m meshwright``, which is how ``torchrun`` starts it."""

import sys


def main() -> int:
    """Run the command line; Ctrl-C during its imports ends in one line as well."""
    try:
        from meshwright import cli

        return cli.main()
    except KeyboardInterrupt:
        sys.stderr.write("meshwright: stopped by Ctrl-C; no file is half written\n")
        return 2


if __name__ == "__main__":
    sys.exit(main())
