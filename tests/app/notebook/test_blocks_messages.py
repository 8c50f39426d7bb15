"""Blocks in a widget: lines, chords and numbers, setting a number, files of the grid."""

from __future__ import annotations

import io
import zipfile

import curved_meshes
import numpy as np
import pytest
from porting import Port

from meshwright.document.document import Document
from meshwright.notebook.protocol import blocks_messages
from meshwright.notebook.session import Session
from meshwright_core.blocks.structure import BlockStructure
from meshwright_core.domains.meshing import benchmark_mesh


@pytest.fixture
def port():
    made = Port(Session.of(Document(curved_meshes.ring(), "ring")))
    made.ask("hello")
    yield made
    made.close()


def lines_of(packet):
    points = np.frombuffer(packet.buffers[0], "<f4").reshape(-1, 2)
    first = np.frombuffer(packet.buffers[1], "<i4")
    return np.split(points, first[1:-1])


def test_edges_are_lines_along_their_curves(port):
    [shown] = port.ask("blocks")
    assert (shown["type"], shown["to"]) == ("blocks", "v")
    structure = BlockStructure.of(port.session.mesh)
    assert shown["ends"] == structure.vertices[structure.edges].tolist()
    assert shown["chord"] == structure.chord.tolist()
    assert len(shown["counts"]) == structure.chord_count and shown["problem"] == ""
    counts = np.array(shown["counts"])
    assert shown["cells"] == int(counts[structure.crossing].prod(axis=1).sum())
    lines = lines_of(port.packets[-1])
    frame = port.session.broadcaster.mesh_sync.frame
    ends = frame.normalised(port.session.mesh.points[structure.vertices[structure.edges]])
    assert all(np.allclose(line[[0, -1]], pair) for line, pair in zip(lines, ends, strict=True))
    assert max(map(len, lines)) > 2
    assert all(len(hues) == structure.chord_count for hues in shown["colours"].values())


def test_a_number_is_a_step_of_the_document(port):
    [shown] = port.ask("blocks")
    ends, chord = shown["ends"][0], shown["chord"][0]
    port.ask("chord_count", ends=ends, count=7)
    document = port.session.document
    assert document.history.last.title == f"Chord {chord}: 7 cells"
    [shown] = port.ask("blocks")
    assert shown["counts"][chord] == 7 and shown["set"] == [chord]
    port.ask("chord_count", ends=ends[::-1], count=None)
    [shown] = port.ask("blocks")
    assert shown["set"] == []
    port.ask("undo")
    [shown] = port.ask("blocks")
    assert shown["counts"][chord] == 7


@pytest.mark.parametrize(
    ("fields", "words"),
    [
        ({"ends": [0, 0], "count": 3}, "in the meantime"),
        ({"ends": [0, 10**6], "count": 3}, "in the meantime"),
        ({"ends": [0, 1], "count": 0}, "Malformed"),
        ({"ends": [0, 1], "count": 10**9}, "Malformed"),
    ],
)
def test_wrong_numbers_are_refused(port, fields, words):
    port.ask("chord_count", **fields)
    assert words in port.sentence and len(port.session.document.history) == 0


def test_files(port):
    [shown] = port.ask("blocks")
    for edge in range(len(shown["ends"])):
        port.ask("chord_count", ends=shown["ends"][edge], count=3)
    [file, said] = port.ask("export_blocks", ending=".su2")
    assert (file["type"], file["name"], file["to"]) == ("file", "ring.su2", "v")
    cells = 9 * port.session.mesh.n_elements
    packet = next(one for one in reversed(port.packets) if one.content["type"] == "file")
    assert f"NELEM= {cells}" in packet.buffers[0].decode()
    assert f"{cells} cells" in said["sentence"]
    port.ask("export_blocks", ending=".xyz")
    packet = next(one for one in reversed(port.packets) if one.content["type"] == "file")
    assert packet.content["name"] == "ring.zip"
    with zipfile.ZipFile(io.BytesIO(packet.buffers[0])) as archive:
        assert sorted(archive.namelist()) == ["ring.nmf", "ring.xyz"]
    port.ask("export_blocks", ending=".exe")
    assert "no such format" in port.sentence


def test_grids_that_are_too_large_to_send(port, monkeypatch):
    monkeypatch.setattr(blocks_messages, "MOST_CELLS", 10)
    port.ask("export_blocks", ending=".geo")
    assert "10 are sent at most" in port.sentence


def test_triangles_have_no_blocks():
    made = Port(Session.of(Document(benchmark_mesh("tri", 8, np.random.default_rng(0)))))
    made.ask("hello")
    made.ask("blocks")
    assert made.sentence == "Only quad meshes have blocks."
    made.close()
