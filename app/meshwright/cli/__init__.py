"""The console command ``meshwright``.

Neither this module nor the modules of the subcommands import heavy packages at their top: each
imports what it needs when it runs, so that ``meshwright --help`` answers at once.

Exit codes: 0 done; 1 internal error; 2 wrong use, bad input, or stopped by Ctrl-C; 3 done, but
elements that were inverted before still are; 141 stdout was closed by its reader.
"""

from __future__ import annotations

import _thread
import argparse
import gc
import os
import signal
import sys
import threading
import traceback
import warnings
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from types import FrameType
from typing import Any, NoReturn

from meshwright.cli.commands import COMMANDS, Command
from meshwright.console import Report, UserError

DONE, BUG, REFUSED, READER_GONE = 0, 1, 2, 141

DEBUG = "MESHWRIGHT_DEBUG"

GARBAGE_THRESHOLD = 20_000
"""New objects after which Python looks for reference cycles; its default is 700."""

REPEATED_AFTER = 0.05
"""Seconds after which a Ctrl-C that was lost is repeated."""

EPILOG = """\
Without a command the window opens; with the name of a mesh file or a shape it opens on that.

examples:
  meshwright demo                                         the star, with the agent ready
  meshwright mesh star -o star.vtk --kind quad            a quad mesh of a shape
  meshwright improve star.vtk -o better.vtk --png a.png   let the policy work on it
  meshwright better.vtk                                   look at it in the window
"""


class Parser(argparse.ArgumentParser):
    """An argument parser that raises UserError instead of printing two lines and exiting."""

    def error(self, message: str) -> NoReturn:
        """Raise UserError with a hint to ``--help``."""
        raise UserError(f"{message} (see {self.prog} --help)")


class Version(argparse.Action):
    """Print the installed version and exit."""

    def __call__(self, parser: argparse.ArgumentParser, *_: object, **__: object) -> None:
        """Read the version only now: reading the package metadata takes time."""
        from importlib.metadata import PackageNotFoundError, version

        try:
            number = version("meshwright")
        except PackageNotFoundError:
            number = "of a source folder that is not installed"
        sys.stdout.write(f"meshwright {number}\n")
        parser.exit()


def build_parser() -> Parser:
    """Return the parser of the whole command line."""
    parser = Parser(
        prog="meshwright",
        description="Edit the connectivity of triangle and quad meshes half-edge by half-edge,\n"
        "by hand or with a trained agent.",
        epilog=EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter,
        allow_abbrev=False,
    )
    parser.add_argument("--version", action=Version, nargs=0, help="print the version and exit")
    subparsers = parser.add_subparsers(
        dest="command", metavar="COMMAND", title="commands", parser_class=Parser
    )
    for name, command in COMMANDS.items():
        sub = subparsers.add_parser(
            name, help=command.SUMMARY, description=command.DESCRIPTION, allow_abbrev=False
        )
        command.add_arguments(sub)
        sub.add_argument(
            "--json", action="store_true", help="print one JSON object on stdout, nothing else"
        )
    return parser


def main(argv: Sequence[str] | None = None) -> int:
    """Run the command line; return the exit code."""
    words = list(sys.argv[1:] if argv is None else argv)
    report = Report(as_json="--json" in words)
    with _rare_garbage_collection(), _noted_warnings(report), _noted_interrupts() as interrupted:
        return _run(words, report, interrupted)


@contextmanager
def _rare_garbage_collection() -> Iterator[None]:
    """Look for reference cycles less often: importing PyTorch and numba makes a great many objects
    that stay, and looking through them again and again takes a tenth of a short command's time.
    """
    usual = gc.get_threshold()
    gc.set_threshold(max(usual[0], GARBAGE_THRESHOLD), *usual[1:])
    try:
        yield
    finally:
        gc.set_threshold(*usual)


@contextmanager
def _noted_warnings(report: Report) -> Iterator[None]:
    """Write what readers and writers of files warn of as remarks, a line each."""
    usual = warnings.showwarning

    def show(message: Warning | str, category: type[Warning], *place: Any, **more: Any) -> None:
        if category.__name__ == "FileWarning":  # by its name: numpy is not imported for this
            report.note(str(message))
        else:
            usual(message, category, *place, **more)

    with warnings.catch_warnings():
        warnings.filterwarnings("always", module="meshwright")
        warnings.showwarning = show
        yield


@contextmanager
def _noted_interrupts() -> Iterator[threading.Event]:
    """Record Ctrl-C in an event besides raising KeyboardInterrupt: a library may turn the exception
    into another one, as numba does while it compiles. Where Python drops the exception, as in
    finalizers and callbacks of C code, Ctrl-C is repeated a moment later.
    """
    noted, left = threading.Event(), threading.Event()
    if threading.current_thread() is not threading.main_thread():
        yield noted
        return

    main_thread = threading.get_ident()

    def note(number: int, frame: FrameType | None) -> None:
        noted.set()
        raise KeyboardInterrupt

    def repeat_interrupt() -> None:
        if left.is_set():
            return
        if sys.platform == "win32":
            _thread.interrupt_main()
        else:  # a true signal also ends what the main thread waits for
            signal.pthread_kill(main_thread, signal.SIGINT)

    def report_unraisable(unraisable: Any) -> None:
        if not isinstance(unraisable.exc_value, KeyboardInterrupt):
            usual(unraisable)
            return
        repeat = threading.Timer(REPEATED_AFTER, repeat_interrupt)
        repeat.daemon = True
        repeat.start()

    before = signal.signal(signal.SIGINT, note)
    usual = sys.unraisablehook
    sys.unraisablehook = report_unraisable
    try:
        yield noted
    finally:
        left.set()
        sys.unraisablehook = usual
        signal.signal(signal.SIGINT, before)


def _run(words: list[str], report: Report, interrupted: threading.Event) -> int:
    name = "meshwright"
    try:
        words = _with_command(words)
        arguments = build_parser().parse_args(words)
        command: Command = COMMANDS[arguments.command]
        name = f"meshwright {arguments.command}"
        return command.run(arguments, report) or DONE
    except BrokenPipeError:
        _silence_stdout()
        return READER_GONE
    except SystemExit as leave:
        return leave.code if isinstance(leave.code, int) else DONE
    except KeyboardInterrupt:
        return _interrupted(report, name)
    except UserError as error:
        _traceback_if_wanted()
        report.error(name, str(error))
        return REFUSED
    except MemoryError:
        _traceback_if_wanted()
        report.error(name, "not enough memory for this")
        return REFUSED
    except Exception as error:
        if interrupted.is_set():
            return _interrupted(report, name)
        shown = _traceback_if_wanted()
        hint = (
            "" if shown else f"; run again with {DEBUG}=1 for the traceback, and please report it"
        )
        report.error(name, f"internal error: {type(error).__name__}: {error}{hint}")
        return BUG


def _interrupted(report: Report, name: str) -> int:
    report.error(name, "stopped by Ctrl-C; no file is half written")
    return REFUSED


def _with_command(words: list[str]) -> list[str]:
    """Return the words, with ``view`` first if they begin with no command."""
    if not words or words == ["--json"] or (words[0][:1] != "-" and words[0] not in COMMANDS):
        return ["view", *words]
    return words


def _traceback_if_wanted() -> bool:
    if not os.environ.get(DEBUG):
        return False
    traceback.print_exc()
    return True


def _silence_stdout() -> None:
    """Redirect stdout, so that the interpreter reports no second error when it exits."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


if __name__ == "__main__":
    sys.exit(main())
