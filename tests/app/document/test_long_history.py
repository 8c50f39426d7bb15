"""Ten thousand operations undone to the first bit and redone, and the memory that they take."""

import gc
import sys
import tracemalloc

import numpy as np
import pytest

from meshwright.document.document import Document
from meshwright_core import HalfEdgeMesh, warm_up
from meshwright_core.core.arrays import ELEMENT_SLOTS
from meshwright_core.domains import gallery, meshing
from meshwright_core.operations.catalogue import of_kind

OPERATIONS = 10_000
LOCAL = ("flip", "flip_left", "flip_right", "split", "collapse")
MOST_BYTES = 2048


@pytest.fixture(scope="module", autouse=True)
def _kernels():
    warm_up.warm()


def everything(mesh: HalfEdgeMesh) -> list[bytes]:
    """All bits of the mesh."""
    return [array.tobytes() for array in (*mesh.arrays[:3], mesh.arrays.counters[:10])]


def work(document: Document, operations: int, rng: np.random.Generator, most: int = 100) -> None:
    """So many local operations at random, those left out that add more than `most` to s."""
    mesh = document.mesh
    infos = [info.operation for info in of_kind(mesh.kind) if info.operation.value in LOCAL]
    until, size = document.history.cursor + operations, mesh.n_elements
    while document.history.cursor < until:
        h = int(rng.integers(mesh.k * mesh.arrays.counters[ELEMENT_SLOTS]))
        operation = infos[rng.integers(len(infos))]
        if not mesh.live(h) or not document.check(operation, h):
            continue
        unwanted = "split" if mesh.n_elements > size else "collapse"
        if operation.value == unwanted:
            continue  # neither more nor fewer elements over time
        if most < 100:
            change = mesh.apply(operation, h).score_change
            mesh.undo()
            if change > most:
                continue
        document.submit(operation, h)


@pytest.mark.parametrize("kind", ["tri", "quad"])
def test_ten_thousand_operations_undone_to_the_first_bit_and_redone(kind):
    mesh = meshing.mesh_domain(gallery.shape("star"), kind, max_edge=0.2)
    mesh.reserve(5000, 5000)
    document = Document(mesh)
    document.auto_smooth = False  # positions of so many random operations are of no use
    first = everything(mesh)
    rng = np.random.default_rng(3)
    some = []
    for _ in range(10):
        work(document, OPERATIONS // 10, rng)
        some.append(everything(mesh))
    assert document.history.cursor == len(document.history) == mesh.steps == OPERATIONS
    assert len(mesh.arrays.steps) < 1000  # the others are packed
    document.go_to(0)
    assert everything(mesh) == first
    for tenth in range(10):
        document.go_to((tenth + 1) * OPERATIONS // 10)
        assert everything(mesh) == some[tenth]
    mesh.validate()


@pytest.mark.parametrize(("kind", "edge"), [("tri", 0.05), ("quad", 0.05)])
def test_a_local_operation_takes_at_most_two_kibibytes(kind, edge):
    """The operation, the smoothing around it, and its row, all together."""
    mesh = meshing.mesh_domain(gallery.shape("star"), kind, max_edge=edge)
    document = Document(mesh)

    def loose() -> int:
        return mesh.arrays.journal.nbytes + mesh.arrays.steps.nbytes

    def footprint() -> int:
        """Bytes of all that was traced, as if the journal were packed."""
        gc.collect()
        sys._clear_type_cache()  # it keeps the names of attributes that compiled code looked up
        used = tracemalloc.get_traced_memory()[0]
        done, _ = mesh.packed_steps()
        return used - loose() + sum(steps.nbytes for steps in done)

    work(document, 10, np.random.default_rng(0), 0)  # loads what is needed
    tracemalloc.start()
    # fills numpy's cache of small arrays, whatever the history's length
    work(document, 40, np.random.default_rng(1), 0)
    before = footprint()
    work(document, 150, np.random.default_rng(2), 0)
    used = footprint() - before
    tracemalloc.stop()
    assert len(mesh.packed_steps()[0]) == 4  # all 200 in the journal: none counts twice
    assert loose() < 2 * 1024 * 1024  # however long the history
    assert used / 150 <= MOST_BYTES
