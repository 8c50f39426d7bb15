"""Writers of surfaces: Wavefront OBJ, Object File Format, STL; exact coordinates, and quads.

Each writer returns the text of the whole file. Where the format has comments the first lines
count points and elements, so that a file that was cut off is noticed on reading.
"""

from __future__ import annotations

import re

import numpy as np

from meshwright_core.io.content import Content
from meshwright_core.io.writers import lines as form

_COUNTS = re.compile(rb"Meshwright: (\d+) points, (\d+) elements")
_COUNTED = 512


def announced_counts(head: bytes) -> tuple[int, int] | None:
    """Return the numbers of points and elements that the first bytes of a file of ours state."""
    found = _COUNTS.search(head[:_COUNTED])
    return (int(found[1]), int(found[2])) if found else None


def write_obj(content: Content) -> str:
    """Return the content as a Wavefront OBJ file."""
    _, elements = form.block(content)
    lines = [f"# Meshwright: {len(content.points)} points, {len(elements)} elements"]
    lines += [f"v {x!r} {y!r} {z!r}" for x, y, z in content.points.tolist()]
    lines += ["f " + " ".join(map(str, element)) for element in (elements + 1).tolist()]
    return form.text(lines)


def write_off(content: Content) -> str:
    """Return the content as an Object File Format file."""
    _, elements = form.block(content)
    lines = ["OFF", f"{len(content.points)} {len(elements)} 0"]
    lines += [f"{x!r} {y!r} {z!r}" for x, y, z in content.points.tolist()]
    head = f"{elements.shape[1]} "
    lines += [head + " ".join(map(str, element)) for element in elements.tolist()]
    return form.text(lines)


def write_stl(content: Content) -> str:
    """Return triangles as an STL text file, the normals by the right-hand rule."""
    corners = content.points[form.block(content)[1]]
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    length = np.linalg.norm(normal, axis=1, keepdims=True)
    normal = np.divide(normal, length, out=np.zeros_like(normal), where=length > 0)
    lines = ["solid meshwright"]
    for (nx, ny, nz), triangle in zip(normal.tolist(), corners.tolist(), strict=True):
        lines += [f"facet normal {nx!r} {ny!r} {nz!r}", "outer loop"]
        lines += [f"vertex {x!r} {y!r} {z!r}" for x, y, z in triangle]
        lines += ["endloop", "endfacet"]
    return form.text([*lines, "endsolid meshwright"])
