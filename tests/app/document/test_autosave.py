"""Autosave and recovery: what was done is there after any end of the process."""

import errno
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
from document_edits import bits, serials, wander

from meshwright.document.document import Document
from meshwright.document.storage import autosave, autosave_log, recovery
from meshwright.document.storage.autosave import Autosave
from meshwright_core import MeshError


@pytest.fixture(params=["quad", "tri"])
def document(request, star, triangles) -> Document:
    return Document(star if request.param == "quad" else triangles, "star")


def recovered(folder) -> Document:
    """The one document that was left there."""
    (lost,) = recovery.lost(folder)
    document = Document()
    document.adopt(lost.read())
    lost.release()
    return document


def test_every_event_is_recovered(document, tmp_path):
    keeper = Autosave(document, tmp_path)
    wander(document, 5, 1)
    document.go_to(2)
    wander(document, 3, 2)
    document.take_branch(0)
    document.smooth()
    document.go_to(1)
    document.set_locked(int(document.mesh.vertices()[0]), True)
    document.go_to(0)
    document.take_branch(0)
    document.undo()
    keeper.leave()
    other = recovered(tmp_path)
    assert bits(other) == bits(document)
    assert (other.name, other.modified, other.history.cursor) == (
        "star",
        True,
        document.history.cursor,
    )
    assert [branch.at for branch in other.history.branches] == [
        branch.at for branch in document.history.branches
    ]
    for _ in range(4):
        for one in (document, other):
            one.take_branch(len(one.history.branches) - 1)
            one.go_to(len(one.history))
        assert bits(other) == bits(document)
        assert serials(other.history) == serials(document.history)
    for one in (document, other):
        one.go_to(0)
        wander(one, 4, 7)
    assert bits(other) == bits(document)
    other.mesh.validate()


def test_a_growing_mesh_is_recorded(document, tmp_path):
    keeper = Autosave(document, tmp_path)
    mesh = document.mesh
    slots = len(mesh.arrays.vertex)
    rng = np.random.default_rng(0)
    document.auto_smooth = False
    while len(mesh.arrays.vertex) == slots:
        h = int(rng.choice(mesh.element_ids())) * mesh.k + int(rng.integers(mesh.k))
        if document.check("split", h):
            document.submit("split", h)
    keeper.leave()
    assert bits(recovered(tmp_path)) == bits(document)


def test_the_file_exists_only_while_changes_are_unsaved(document, tmp_path):
    keeper = Autosave(document, tmp_path / "deep" / "folder")
    assert keeper.path is None
    document.smooth()
    first = keeper.path
    assert first is not None and first.exists()
    document.undo()
    assert first.exists()  # what was undone could still be done again
    document.save(tmp_path / "a.vtk")
    assert not first.exists()
    assert keeper.path.exists()  # a mesh file has no history
    document.save(tmp_path / "a.meshwright")
    assert keeper.path is None
    wander(document, 1, 1)
    second = keeper.path
    assert second.exists() and second != first
    document.replace(None)
    assert not second.exists()
    keeper.close()
    assert recovery.lost(tmp_path / "deep" / "folder") == []


def test_closing_and_disabling_remove_the_file(document, tmp_path):
    keeper = Autosave(document, tmp_path)
    wander(document, 2, 1)
    keeper.enabled = False
    wander(document, 1, 2)
    assert list(tmp_path.iterdir()) == []
    keeper.enabled = True
    wander(document, 1, 3)
    keeper.leave()
    assert bits(recovered(tmp_path)) == bits(document)
    keeper = Autosave(document, tmp_path)
    keeper.close()


def test_an_incomplete_end_gives_the_last_complete_state(document, tmp_path):
    keeper = Autosave(document, tmp_path)
    states = []
    sizes = []
    for seed in range(6):
        wander(document, 1, seed)
        states.append(bits(document))
        sizes.append(keeper.path.stat().st_size)
    path = keeper.path
    keeper.leave()
    whole = path.read_bytes()
    rng = np.random.default_rng(1)
    for end in [*sizes, *rng.integers(sizes[0], len(whole), size=20).tolist()]:
        path.write_bytes(whole[:end])
        last = sum(size <= end for size in sizes) - 1
        assert bits(recovered(tmp_path)) == states[last]
    for _ in range(40):  # one spoilt byte: all that stands before its record
        spoilt = bytearray(whole)
        at = int(rng.integers(sizes[0], len(whole)))
        spoilt[at] ^= 0x55
        path.write_bytes(spoilt)
        last = sum(size <= at for size in sizes) - 1
        assert bits(recovered(tmp_path)) == states[last]
    path.write_bytes(whole[: sizes[0] - 1])
    assert recovery.lost(tmp_path) == []
    assert not path.exists()  # there was no whole document in it


def test_offered_operations(document, tmp_path):
    keeper = Autosave(document, tmp_path)
    wander(document, 4, 1)
    document.undo()
    keeper.leave()
    before = time.time()
    (lost,) = recovery.lost(tmp_path)
    assert (lost.name, lost.file) == ("star", None)
    assert abs(lost.when - before) < 60
    assert lost.now == {
        "steps": 3,
        "score": document.score,
        "optimum": document.optimum,
        "elements": document.mesh.n_elements,
        "kind": document.kind,
    }
    assert recovery.lost(tmp_path) == []  # it is held
    lost.release()
    (lost,) = recovery.lost(tmp_path)
    lost.discard()
    assert list(tmp_path.iterdir()) == []


def test_files_of_running_processes_are_ignored(document, tmp_path):
    keeper = Autosave(document, tmp_path)
    wander(document, 1, 1)
    assert recovery.lost(tmp_path) == []
    code = f"""
import sys
from pathlib import Path
from meshwright.document.storage import recovery
sys.exit(len(recovery.lost(Path({str(tmp_path)!r}))))
"""
    assert subprocess.run([sys.executable, "-c", code], timeout=60).returncode == 0
    keeper.leave()
    assert subprocess.run([sys.executable, "-c", code], timeout=60).returncode == 1


class FullDisk:
    """Takes so many bytes more, then none."""

    def __init__(self, monkeypatch) -> None:
        self.left = 1 << 40
        self.write = os.write
        monkeypatch.setattr(autosave.os, "write", self)

    def __call__(self, descriptor, data) -> int:
        if not self.left:
            raise OSError(errno.ENOSPC, "No space left on device")
        count = self.write(descriptor, data[: self.left])
        self.left -= count
        return count


def test_a_full_disk_is_reported_and_writing_resumes(document, tmp_path, monkeypatch):
    disk = FullDisk(monkeypatch)
    keeper = Autosave(document, tmp_path)
    reported, resumed = [], []
    keeper.failed.connect(reported.append)
    keeper.resumed.connect(resumed.append)
    wander(document, 2, 1)
    two = bits(document)
    disk.left = 100
    wander(document, 3, 2)
    document.undo()
    assert len(reported) == 1
    assert "no space left" in reported[0] and reported[0].endswith(".")
    copy = tmp_path / "copy"
    copy.mkdir()
    (copy / "a.journal").write_bytes(keeper.path.read_bytes())
    assert bits(recovered(copy)) == two
    disk.left = 1 << 40
    wander(document, 1, 3)
    assert resumed == ["Autosave works again."]
    keeper.leave()
    assert bits(recovered(tmp_path)) == bits(document)


def test_a_disk_that_is_full_from_the_start(document, tmp_path, monkeypatch):
    disk = FullDisk(monkeypatch)
    disk.left = 500
    keeper = Autosave(document, tmp_path)
    reported = []
    keeper.failed.connect(reported.append)
    wander(document, 3, 1)
    assert len(reported) == 1
    assert list(tmp_path.iterdir()) == []
    disk.left = 1 << 40
    deadline = time.monotonic() + 20
    while keeper.path is None and time.monotonic() < deadline:
        wander(document, 1, 3)
    keeper.leave()
    assert bits(recovered(tmp_path)) == bits(document)


def test_a_folder_that_cannot_be_made_is_reported(document, tmp_path):
    (tmp_path / "file").write_text("in the way")
    keeper = Autosave(document, tmp_path / "file" / "state")
    reported = []
    keeper.failed.connect(reported.append)
    wander(document, 3, 1)
    assert len(reported) == 1
    assert document.history.cursor == 3
    keeper.close()
    assert recovery.lost(tmp_path / "file" / "state") == []


def test_a_complete_but_invalid_file_is_reported_and_kept(document, tmp_path):
    path = tmp_path / "1-a.journal"
    header = {"event": "document", "name": "odd", "version": 1}
    path.write_bytes(b"".join(autosave_log.encoded(header, {})))
    (lost,) = recovery.lost(tmp_path)
    with pytest.raises(MeshError, match=r"What was kept of odd cannot be recovered.*\.$"):
        lost.read()
    lost.release()
    assert path.exists()


HELPERS = Path(__file__).parents[2] / "helpers"
CHILD = """
import sys
from pathlib import Path
import numpy as np
from meshwright.document.storage.autosave import Autosave
from meshwright.document.document import Document
from meshwright_core.domains import gallery, meshing
sys.path.insert(0, {tests!r})
from document_edits import wander

document = Document(meshing.mesh_domain(gallery.shape("star"), {kind!r}), "star")
keeper = Autosave(document, Path({folder!r}))
for seed in range(1_000_000):
    wander(document, 1, seed)
    print(document.history.cursor, document.score, flush=True)
"""


@pytest.mark.parametrize("seconds", [0.0, 0.05, 0.3])
@pytest.mark.skipif(sys.platform == "win32", reason="no such signal")
@pytest.mark.slow
def test_kill_9_loses_at_most_the_last_operation(tmp_path, seconds):
    code = CHILD.format(tests=str(HELPERS), folder=str(tmp_path), kind="quad")
    child = subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, text=True)
    reported = [child.stdout.readline()]
    time.sleep(seconds)
    child.send_signal(signal.SIGKILL)
    reported += child.stdout.readlines()
    child.wait(30)
    cursor, score = map(int, [line for line in reported if line.endswith("\n")][-1].split())
    document = recovered(tmp_path)
    # the child may have done one more, and not have printed it
    assert document.history.cursor in (cursor, cursor + 1)
    assert [0, *(row.after for row in document.history)][cursor] == score
    document.mesh.validate()
    reached = bits(document)
    document.go_to(0)
    assert document.score == 12
    document.go_to(len(document.history))
    assert bits(document) == reached
