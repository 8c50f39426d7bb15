"""Patches: the named sides of the boundary of a block structure."""

from __future__ import annotations

import itertools
import re
import unicodedata
from collections.abc import Container
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from meshwright_core.core.curve_edges import edge_places

if TYPE_CHECKING:
    from meshwright_core.mesh import HalfEdgeMesh

_NOT_PLAIN = re.compile(r"[^A-Za-z0-9_.-]+")


@dataclass(frozen=True, eq=False)
class Patch:
    """A part of the boundary with one name."""

    name: str
    """Letters, digits, "_", "-" and ".", as all file formats permit them."""
    edges: np.ndarray
    """(p,) block edges, in the order of the boundary."""
    title: str
    """The name as it was drawn; `name` where there is none."""


def boundary_patches(
    mesh: HalfEdgeMesh, halfedges: np.ndarray, edges: np.ndarray
) -> tuple[Patch, ...]:
    """The patches of a mesh, in the order of its boundary loops.

    A boundary edge belongs to the drawn piece at the middle of its range. Pieces without a name
    are joined to one patch for each loop: "outline" and "hole_1", "hole_2" and so on.

    Args:
        mesh: of quads.
        halfedges: (p,) all half-edges of the boundary.
        edges: (p,) what to call each of them.
    """
    order = _around(mesh, halfedges)
    halfedges, edges = halfedges[order], edges[order]
    curve, span = edge_places(mesh.arrays, halfedges, mesh.k)
    lengths = mesh.boundary_info.lengths()
    pieces, loops = mesh.boundary_info.pieces, _loop_names(mesh)
    found: dict[str, list[int]] = {}
    for edge, c, (low, high) in zip(edges.tolist(), curve.tolist(), span, strict=True):
        t = 0.5 * (low + high) % lengths[c]
        name = ""
        for piece in pieces[c] if c < len(pieces) else ():
            if piece.start <= t < piece.stop:
                name = piece.name
        found.setdefault(name.strip() or loops.get(c, "outline"), []).append(edge)
    patches: list[Patch] = []
    for number, (title, rows) in enumerate(found.items(), start=1):
        name = unlike(plain_name(title) or f"side_{number}", {patch.name for patch in patches})
        patches.append(Patch(name, np.array(rows, np.int64), title))
    return tuple(patches)


def plain_name(name: str) -> str:
    """The name with every run of other characters than letters, digits, _ - . as one "_", and
    letters without their accents.
    """
    bare = unicodedata.normalize("NFKD", name)
    bare = "".join(sign for sign in bare if not unicodedata.combining(sign))
    return _NOT_PLAIN.sub("_", bare.strip()).strip("_")


def unlike(name: str, taken: Container[str]) -> str:
    """The name, with a number behind it where it is taken."""
    tried = (f"{name}_{number}" for number in itertools.count(2))
    return name if name not in taken else next(one for one in tried if one not in taken)


def _around(mesh: HalfEdgeMesh, halfedges: np.ndarray) -> np.ndarray:
    """The order of boundary half-edges along the loops: by curve and parameter."""
    curve, span = edge_places(mesh.arrays, halfedges, mesh.k)
    order: np.ndarray = np.lexsort((span[:, 0], curve))
    return order


def _loop_names(mesh: HalfEdgeMesh) -> dict[int, str]:
    """A name for each boundary curve: an outline runs counter-clockwise, a hole clockwise."""
    names: dict[int, str] = {}
    outlines: list[int] = []
    holes: list[int] = []
    for loop in mesh.boundary_loops():
        at = mesh.points[loop]
        x, y = at[:, 0], at[:, 1]
        area = float(x @ np.roll(y, -1) - y @ np.roll(x, -1))
        curve = int(mesh.curve_ids()[loop[0]])
        (outlines if area > 0.0 else holes).append(curve)
    if not outlines:  # a surface in space: the loops have no sides
        outlines, holes = holes, []
    for i, curve in enumerate(outlines, start=1):
        names[curve] = "outline" if len(outlines) == 1 else f"outline_{i}"
    names.update({curve: f"hole_{i}" for i, curve in enumerate(holes, start=1)})
    return names
