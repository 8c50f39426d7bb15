"""The command line's manners: streams, exit codes, one line for an error."""

import io
import json
import signal
import subprocess
import sys
import threading
from pathlib import Path

import numpy as np
import pytest

from meshwright import __main__, cli, console
from meshwright.cli import output_files
from meshwright.cli.commands import COMMANDS, shapes
from meshwright.console import Report, UserError


def raising(error: BaseException):
    def run(arguments, report):
        raise error

    return run


@pytest.fixture
def broken(monkeypatch):
    """Make ``meshwright shapes`` raise the given error."""
    monkeypatch.delenv(cli.DEBUG, raising=False)
    return lambda error: monkeypatch.setattr(shapes, "run", raising(error))


def test_help_names_every_command(capsys):
    assert cli.main(["--help"]) == 0
    printed = capsys.readouterr()
    assert printed.err == ""
    for name, command in COMMANDS.items():
        assert f"    {name}" in printed.out
        assert command.SUMMARY.split()[0] in printed.out


@pytest.mark.parametrize("name", list(COMMANDS))
def test_every_command_has_help_and_json(name, capsys):
    assert cli.main([name, "--help"]) == 0
    assert "--json" in capsys.readouterr().out


def test_version(capsys):
    assert cli.main(["--version"]) == 0
    assert capsys.readouterr().out.startswith("meshwright ")


@pytest.mark.parametrize(
    ("words", "expected"),
    [
        (["improve"], "the following arguments are required: IN, -o/--output"),
        (["mesh", "star", "-o", "a.vtk", "--kind", "hex"], "invalid choice: 'hex'"),
        (["mesh", "star", "-o", "a.vtk", "--kind", "tri", "--max-edge", "nan"], "above 0"),
        (["mesh", "star", "-o", "a.vtk", "--kind", "tri", "--max-edge", "0"], "above 0"),
        (["mesh", "star", "-o", "a.vtk", "--kind", "tri", "--seed", "-1"], "at least 0"),
        (["improve", "a.vtk", "-o", "b.vtk", "--rollouts", "none"], "not a whole number"),
        (["improve", "a.vtk", "-o", "b.vtk", "--rollouts", "2", "--search", "1"], "not allowed"),
        (["improve", "a.vtk", "-o", "b.vtk", "--corner-angle", "200"], "0 to 180 degrees"),
        (["evaluate", "--kind", "quad", "--sides", "20-10"], "3 sides or more, fewest first"),
        (["evaluate", "--kind", "quad", "--sides", "ten"], "not a range such as 10-20"),
        (["shapes", "--loud"], "unrecognized arguments: --loud"),
        (["--loud"], "unrecognized arguments: --loud"),
    ],
)
def test_wrong_use_is_one_line_and_code_2(words, expected, capsys):
    assert cli.main(words) == 2
    printed = capsys.readouterr()
    assert printed.out == ""
    assert printed.err.count("\n") == 1
    assert expected in printed.err
    assert "--help" in printed.err


def test_wrong_use_with_json_is_still_one_object(capsys):
    assert cli.main(["improve", "--json"]) == 2
    printed = capsys.readouterr()
    assert "required" in json.loads(printed.out)["error"]
    assert printed.err.count("\n") == 1


def test_user_error_is_one_line_whatever_the_message(broken, capsys):
    broken(UserError("first\n  second"))
    assert cli.main(["shapes"]) == 2
    assert capsys.readouterr().err == "meshwright shapes: first second\n"


def test_internal_error_is_not_reported_as_bad_input(broken, capsys):
    broken(ValueError("of ours"))
    assert cli.main(["shapes"]) == 1
    printed = capsys.readouterr().err
    assert printed.count("\n") == 1
    assert "internal error: ValueError: of ours" in printed
    assert "MESHWRIGHT_DEBUG=1" in printed


def test_internal_error_shows_its_traceback_with_the_debug_variable(broken, capsys, monkeypatch):
    broken(ValueError("of ours"))
    monkeypatch.setenv(cli.DEBUG, "1")
    assert cli.main(["shapes"]) == 1
    assert "Traceback" in capsys.readouterr().err


def test_interrupt_is_one_line_and_code_2(broken, capsys):
    broken(KeyboardInterrupt())
    assert cli.main(["shapes"]) == 2
    assert capsys.readouterr().err.count("\n") == 1


def test_memory_error_is_one_line_and_code_2(broken, capsys):
    broken(MemoryError())
    assert cli.main(["shapes"]) == 2
    assert "not enough memory" in capsys.readouterr().err


def test_closed_stdout_is_not_reported():
    code = (
        "import sys; from meshwright.cli import main; from meshwright.cli.commands import shapes; "
        "shapes.run = lambda _, report: report.result({}, 'text'); sys.exit(main(['shapes']))"
    )
    child = subprocess.Popen(
        [sys.executable, "-u", "-c", code], stdout=subprocess.PIPE, stderr=subprocess.PIPE
    )
    child.stdout.close()
    printed = child.stderr.read()
    child.stderr.close()
    assert child.wait() == cli.READER_GONE
    assert printed == b""


def test_json_turns_numpy_and_nan_into_plain_values():
    values = {"a": np.float64(1.5), "b": np.arange(2), "c": float("nan"), "d": Path("x"), 3: (1,)}
    assert json.loads(console.as_json(values)) == {
        "a": 1.5,
        "b": [0, 1],
        "c": None,
        "d": "x",
        "3": [1],
    }


def test_progress_is_shown_on_terminals_only(monkeypatch):
    stream = io.StringIO()
    monkeypatch.setattr(sys, "stderr", stream)
    with Report().progress("work", 3) as update:
        update(1, "s = 3")
    assert stream.getvalue() == ""


def test_progress_is_shown_on_a_terminal(monkeypatch):
    stream = io.StringIO()
    stream.isatty = lambda: True
    monkeypatch.setattr(sys, "stderr", stream)
    with Report().progress("work", 3) as update:
        update(1, "s = 3")
    assert "s = 3" in stream.getvalue()


@pytest.mark.parametrize(
    ("name", "expected"),
    [
        ("missing/a.vtk", "does not exist"),
        ("file.txt/a.vtk", "is not a folder"),
        (".", "is a folder"),
        ("a.docx", "cannot write the ending .docx; use one of .vtk .obj"),
        ("a", "a name without an ending"),
    ],
)
def test_output_is_checked_before_the_work(tmp_path, name, expected):
    (tmp_path / "file.txt").write_text("")
    with pytest.raises(UserError, match=expected):
        output_files.checked_output(str(tmp_path / name), (".vtk", ".obj"))


def test_output_may_be_new_or_replaced(tmp_path):
    assert output_files.checked_output(str(tmp_path / "a.VTK"), (".vtk",)) == tmp_path / "a.VTK"
    (tmp_path / "a.VTK").write_text("old")
    assert output_files.checked_output(str(tmp_path / "a.VTK"), (".vtk",)) == tmp_path / "a.VTK"


def test_folder_is_checked_before_the_work(tmp_path):
    assert output_files.checked_folder(str(tmp_path / "new")) == tmp_path / "new"
    (tmp_path / "file").write_text("")
    with pytest.raises(UserError, match="that is a file"):
        output_files.checked_folder(str(tmp_path / "file"))
    with pytest.raises(UserError, match="does not exist"):
        output_files.checked_folder(str(tmp_path / "no" / "new"))
    deep = tmp_path / "no" / "new"
    assert output_files.checked_folder(str(deep), parents=True) == deep
    with pytest.raises(UserError, match="is a file"):
        output_files.checked_folder(str(tmp_path / "file" / "new"), parents=True)


def test_replacing_puts_the_new_file_in_place(tmp_path):
    target = tmp_path / "a.png"
    target.write_text("old")
    with output_files.replacing(target) as temporary:
        temporary.write_text("new")
    assert target.read_text() == "new"
    assert list(tmp_path.iterdir()) == [target]


@pytest.mark.parametrize("error", [OSError(28, "No space left on device"), KeyboardInterrupt()])
def test_replacing_keeps_the_old_file_when_writing_fails(tmp_path, error):
    target = tmp_path / "a.png"
    target.write_text("old")

    def write():
        with output_files.replacing(target) as temporary:
            temporary.write_text("half")
            raise error

    with pytest.raises((UserError, KeyboardInterrupt)) as caught:
        write()
    assert isinstance(error, KeyboardInterrupt) or "no space left on device" in str(caught.value)
    assert target.read_text() == "old"
    assert list(tmp_path.iterdir()) == [target]


def test_an_interrupt_that_a_finalizer_swallows_is_repeated(monkeypatch, capsys):
    class Interrupted:
        def __del__(self) -> None:
            signal.raise_signal(signal.SIGINT)

    def run(*_: object) -> None:
        Interrupted()  # Python drops what its finalizer raises
        # there it is delivered when the wait has ended
        threading.Event().wait(5.0 if sys.platform == "win32" else None)
        raise AssertionError("not interrupted")

    monkeypatch.setattr(shapes, "run", run)
    assert cli.main(["shapes"]) == 2
    assert "stopped by Ctrl-C" in capsys.readouterr().err


def test_an_interrupt_during_the_imports_is_one_line(monkeypatch, capsys):
    def interrupted() -> int:
        raise KeyboardInterrupt

    monkeypatch.setattr(cli, "main", interrupted)
    assert __main__.main() == 2
    assert capsys.readouterr().err == "meshwright: stopped by Ctrl-C; no file is half written\n"
