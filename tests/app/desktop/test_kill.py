"""``kill -9`` of a window in the middle of an agent's run, and of a save."""

import signal
import subprocess
import sys
from pathlib import Path

import pytest

from meshwright.desktop.files.unsaved_work import UnsavedWorkGuard
from meshwright.document.document import Document
from meshwright.document.history import YOU
from meshwright.document.storage import recovery

pytestmark = [
    pytest.mark.skipif(sys.platform == "win32", reason="no such signal"),
    pytest.mark.needs("window"),
    pytest.mark.slow,
]

CHILD = """
import sys, time
from pathlib import Path
sys.path.insert(0, {tests!r})
from conftest import Greedy
from meshwright.assistant.assistant import Assistant
from meshwright.desktop.main_window.startup import application
from meshwright.desktop.application.main_thread import Dispatcher
from meshwright.desktop.application.settings import Settings
from meshwright.desktop.main_window.window import MainWindow
from meshwright.document.document import Document
from meshwright.document.history import YOU
from meshwright_core import warm_up
from meshwright_core.domains import gallery, meshing

warm_up.warm()
folder = Path({folder!r})
app = application()
document = Document(meshing.mesh_domain(gallery.shape("star"), "quad"), "star")
assistant = Assistant(
    document,
    Dispatcher(),
    load=lambda name: name,
    make_runner=lambda mesh, policy, seed: Greedy(mesh, bad_steps=500, longest=500),
)
assistant.policy = "greedy"
settings = Settings(str(folder / "settings.ini"))
window = MainWindow(document, assistant=assistant, ready=True, settings=settings)
window.files.watch(folder / "state")
document.history_changed.connect(
    lambda: print("at", document.history.cursor, document.score, flush=True)
)
{work}
window.opened.connect(begin)
window.show()
app.exec()
"""

RUN = """
def begin():
    assistant.speed = 60.0
    assistant.play()
"""

SAVE = """
import numpy as np

def begin():
    document.save(folder / "star.meshwright")
    document.smooth()
    assistant.cancel()
    halfedge = next(h for h in range(96) if document.check("flip_left", h))
    document.submit("flip_left", halfedge)
    write, count = np.lib.format.write_array, 0

    def slow(*arguments, **options):
        nonlocal count
        count += 1
        write(*arguments, **options)
        if count == 6:
            print("saving", flush=True)
            time.sleep(60)

    np.lib.format.write_array = slow
    window.actions_by_id["save"].trigger()
"""


def child_of(tmp_path: Path, work: str) -> subprocess.Popen:
    code = CHILD.format(tests=str(Path(__file__).parents[1]), folder=str(tmp_path), work=work)
    return subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, text=True)


def killed(child: subprocess.Popen, enough) -> list[str]:
    """Read the child's output until ``enough(line)``, then kill it; returns all complete lines."""
    lines = []
    for line in child.stdout:
        lines.append(line)
        if enough(line):
            break
    child.send_signal(signal.SIGKILL)
    lines += child.stdout.readlines()
    assert child.wait(30) == -signal.SIGKILL
    return [line for line in lines if line.endswith("\n")]


def test_kill_during_a_run(qtbot, open_window, tmp_path):
    child = child_of(tmp_path, RUN)
    lines = killed(child, lambda line: line.startswith("at 17 "))
    cursor, score = map(int, lines[-1].split()[1:])
    assert cursor >= 17
    (lost,) = recovery.lost(tmp_path / "state")
    assert (lost.name, lost.file) == ("star", None)
    assert lost.now["steps"] in (
        cursor,
        cursor + 1,
    )  # one more step may have been applied but not printed
    lost.release()

    window = open_window()
    window.files.watch(tmp_path / "state")
    offered = []

    def take(guard: UnsavedWorkGuard, works) -> None:
        offered.extend(works)
        guard._recover(works[0])

    guard = window.files.guard
    guard._offer = lambda works: take(guard, works)
    guard.offer()
    document = window.document
    assert len(offered) == 1
    assert document.history.cursor in (cursor, cursor + 1)
    assert document.history[cursor - 1].after == score
    assert document.history[cursor - 1].by != YOU
    document.mesh.validate()
    document.go_to(0)
    assert document.score == 12
    document.mesh.validate()


def test_kill_during_a_save(tmp_path):
    child = child_of(tmp_path, SAVE)
    killed(child, lambda line: line == "saving\n")
    old = Document()
    old.open(tmp_path / "star.meshwright")
    assert (old.history.cursor, old.score) == (0, 12)
    (lost,) = recovery.lost(tmp_path / "state")
    document = Document()
    document.adopt(lost.read())
    lost.release()
    assert [row.action for row in document.history] == ["smooth", "flip_left"]
    assert document.history.cursor == 2
    assert document.modified
    assert document.path == tmp_path / "star.meshwright"
    document.save()
    old.open(tmp_path / "star.meshwright")
    assert old.history.cursor == 2
