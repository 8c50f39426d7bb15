"""Checks and writes the mesh file of a command, and measures the mesh for its report."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from meshwright.cli.output_files import checked_output
from meshwright.console import UserError

if TYPE_CHECKING:
    from meshwright_core import HalfEdgeMesh

SHOWN_IDS = 20
SHOWN_REGIONS = 6


def checked_mesh_output(path: str, kind: str | None = None) -> Path:
    """Return the path if a mesh of this kind, or of any, can be written there; else UserError."""
    from meshwright_core.core.kinds import ELEMENT_NOUN
    from meshwright_core.io import formats

    noun = ELEMENT_NOUN.get(kind or "")
    fit = [
        ending
        for ending, form in formats.FORMATS.items()
        if (noun in form.kinds if noun else form.kinds)
    ]
    return checked_output(path, tuple(fit))


def write_mesh(path: Path, mesh: HalfEdgeMesh) -> None:
    """Write the mesh atomically; raise UserError if the system refuses."""
    import meshwright_core
    from meshwright_core.errors import MeshError

    try:
        meshwright_core.write(path, mesh)
    except MeshError as error:
        raise UserError(str(error)) from error


def inverted_words(rows: Sequence[int], lead: str = "") -> str:
    """Name the inverted elements, or return an empty text if there are none."""
    if not rows:
        return ""
    named = " ".join(str(row) for row in rows[:SHOWN_IDS])
    more = f" and {len(rows) - SHOWN_IDS} more" if len(rows) > SHOWN_IDS else ""
    return f"{lead}{len(rows)} inverted (elements {named}{more}, counted from 0)"


def measures(mesh: HalfEdgeMesh) -> dict[str, Any]:
    """Area, shapes with their bounds, all with true edges, blocks, and the regions if there are
    several.

    For the JSON of a command. "shape_bound" is q*, "attainable" the bound on the worst scaled
    Jacobian of meshes at s*; "blocks" is for quads only.
    """
    import numpy as np

    from meshwright_core.analysis.blocks import block_count
    from meshwright_core.geometry import quality
    from meshwright_core.geometry.edge_curves import element_areas
    from meshwright_core.geometry.element_shapes import element_shapes
    from meshwright_core.geometry.shape_bound import attainable_bound, shape_bound

    areas, region = element_areas(mesh), mesh.regions()
    values: dict[str, Any] = {
        "area": float(areas.sum()),
        "worst_scaled_jacobian": float(quality.scaled_jacobian(mesh).min()),
        "shape_bound": shape_bound(mesh),
        "attainable": attainable_bound(mesh),
        "worst_shape": float(element_shapes(mesh).min()),
        "sum_of_squares": int((mesh.irregularity() ** 2).sum()),
        "valid": not len(quality.inverted(mesh)),
    }
    if mesh.kind == "quad":
        values["blocks"] = block_count(mesh)
    names = mesh.region_names
    if len(names) > 1:
        counts = np.bincount(region, minlength=len(names))
        sizes = np.bincount(region, areas, minlength=len(names))
        values["regions"] = [
            {"name": name, "elements": int(count), "area": float(size)}
            for name, count, size in zip(names, counts, sizes, strict=True)
        ]
    return values


def counted(number: int, kind: str) -> str:
    """``1 quad``, ``24 triangles``."""
    from meshwright_core.core.kinds import ELEMENT_NOUN

    return f"{number:,} {ELEMENT_NOUN[kind]}{'' if number == 1 else 's'}"


def measure_rows(values: dict[str, Any]) -> list[tuple[str, str]]:
    """Rows of a report for what :func:`measures` returned; ``values`` has the kind too."""
    rows = [
        ("area", f"{values['area']:.10g}"),
        ("shape", shape_words(values)),
        ("sum of squares", f"{values['sum_of_squares']:,}"),
    ]
    if "blocks" in values:
        rows.append(("blocks", f"{values['blocks']:,}"))
    regions = region_words(values)
    return [*rows, ("regions", regions)] if regions else rows


def shape_words(values: dict[str, Any]) -> str:
    """``worst scaled Jacobian 0.72 of at most 0.72; worst shape 0.41``, of :func:`measures`.

    The bound holds for meshes at s*.
    """
    worst, bound = values["worst_scaled_jacobian"], values["attainable"]
    limit = f" of at most {bound:.2f}" if worst <= bound + 0.005 else ""
    return f"worst scaled Jacobian {worst:.2f}{limit}; worst shape {values['worst_shape']:.2f}"


def region_words(values: dict[str, Any]) -> str:
    """``steel 12 quads, copper 8 quads``; empty unless :func:`measures` found several regions."""
    regions = values.get("regions", [])
    words = [
        f"{region['name'] or f'region {number}'} {counted(region['elements'], values['kind'])}"
        for number, region in enumerate(regions[:SHOWN_REGIONS], start=1)
    ]
    if len(regions) > SHOWN_REGIONS:
        words.append(f"and {len(regions) - SHOWN_REGIONS:,} more")
    return ", ".join(words)
