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
    fit = [ending for ending, form in formats.FORMATS.items() if not noun or noun in form.kinds]
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
    """Area and worst scaled Jacobian, both with true edges, and the regions if there are several.

    For the JSON of a command.
    """
    import numpy as np

    from meshwright_core.geometry import quality
    from meshwright_core.geometry.edge_curves import element_areas

    areas, region = element_areas(mesh), mesh.regions()
    values: dict[str, Any] = {
        "area": float(areas.sum()),
        "worst_scaled_jacobian": float(quality.scaled_jacobian(mesh).min()),
    }
    names = mesh.region_names
    if len(names) > 1:
        counts = np.bincount(region, minlength=len(names))
        sizes = np.bincount(region, areas, minlength=len(names))
        values["regions"] = [
            {"name": name, "elements": int(count), "area": float(size)}
            for name, count, size in zip(names, counts, sizes, strict=True)
        ]
    return values


def measure_rows(values: dict[str, Any], noun: str) -> list[tuple[str, str]]:
    """Rows of a report for what :func:`measures` returned; ``noun``: of elements, in the plural."""
    rows = [
        ("area", f"{values['area']:.10g}"),
        ("shape", f"worst scaled Jacobian {values['worst_scaled_jacobian']:.2f}"),
    ]
    regions = region_words(values, noun)
    return [*rows, ("regions", regions)] if regions else rows


def region_words(values: dict[str, Any], noun: str) -> str:
    """``steel 12 quads, copper 8 quads``; empty unless :func:`measures` found several regions."""
    regions = values.get("regions", [])
    words = [
        f"{region['name'] or f'region {number}'} {region['elements']:,} {noun}"
        for number, region in enumerate(regions[:SHOWN_REGIONS], start=1)
    ]
    if len(regions) > SHOWN_REGIONS:
        words.append(f"and {len(regions) - SHOWN_REGIONS:,} more")
    return ", ".join(words)
