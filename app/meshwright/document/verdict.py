"""What can be said of a mesh as an answer: connectivity, shape, inverted elements, irregularity."""

from __future__ import annotations

from dataclasses import dataclass

from meshwright.document.quality_summary import decimal, shape_in_order, shape_words
from meshwright_core import HalfEdgeMesh
from meshwright_core.geometry.element_sines import THIN


@dataclass(frozen=True)
class Finding:
    """One statement, and whether what it says is in order."""

    text: str
    in_order: bool


def largest_delta(mesh: HalfEdgeMesh) -> int:
    """The largest |delta| of a vertex."""
    count = mesh.irregular_count
    if not count:
        return 0
    irregular = mesh.arrays.irregular[:count]
    return int(abs(mesh.irregularity()[irregular]).max())


def gap_words(score: int, optimum: int, name: str = "it") -> str:
    """How far s is from s*, as ``4 above it``.

    Below s* nothing can be drawn: operations, which do not look at shapes, may lead there.
    """
    gap = score - optimum
    return f"{gap:,} above {name}" if gap >= 0 else f"{-gap:,} below {name}: no valid mesh is"


def findings(
    mesh: HalfEdgeMesh, worst: float, flattest: float, bound: float, inverted: int
) -> tuple[Finding, ...]:
    """Shape, inverted elements and largest |delta| of ``mesh``, in words; long thin elements too
    if there are any, by the measure of searches.

    Args:
        mesh: the mesh.
        worst: its worst scaled Jacobian.
        flattest: its worst element shape.
        bound: q*.
        inverted: number of its inverted elements.
    """
    delta = largest_delta(mesh)
    least = 1 if mesh.optimum else 0
    said = (
        Finding(f"Shape {shape_words(worst, bound)}", shape_in_order(worst, bound)),
        Finding(f"{inverted:,} inverted" if inverted else "Nothing inverted", not inverted),
        Finding(f"Largest |\u0394| {delta}", delta <= least),
    )
    if inverted or shape_in_order(THIN * flattest, bound):
        return said
    return (*said, Finding(f"Long thin elements: shape {decimal(flattest)}", False))
