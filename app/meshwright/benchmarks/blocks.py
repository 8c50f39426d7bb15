"""Twenty parts from their curves to block grids in every format, and as Gmsh meshes them.

Each part is meshed, searched for so many seconds, divided into about 4,000 cells and written in
each format that keeps the blocks. Where Gmsh's module is installed, its quasi-structured mesh of
about the same number of cells stands beside it, with the seconds of the last of its attempts.
"""

from __future__ import annotations

import importlib.util
import tempfile
import time
from pathlib import Path
from typing import Any

import numpy as np

from meshwright.assistant.block_search import BlockSearch, decomposed
from meshwright.benchmarks.parts import aligned, shown
from meshwright.console import Update
from meshwright_agent.policy import policy_files
from meshwright_core.blocks.grid import BlockGrid, Sizing, block_grid
from meshwright_core.blocks.structure import BlockStructure
from meshwright_core.domains import meshing
from meshwright_core.domains.block_parts import TUTORIAL_BLOCKS, block_parts
from meshwright_core.domains.domain import Domain
from meshwright_core.errors import MeshError
from meshwright_core.io.grids.block_files import write_blocks
from meshwright_core.io.grids.gmsh_geo import geo_text

SUMMARY = "twenty parts as block grids: s, s*, blocks, cells, worst shapes, every format, and Gmsh"
SECONDS = 10.0
"""Default search time for each part, in seconds."""

CELLS = 4000
QUICK = 2
FORMATS = (".geo", ".msh", "blockMeshDict", ".xyz", ".p3d", ".cgns", ".vtm", ".su2", ".inp", ".bdf")
GOOD = 0.3
_PEER = 11
"""Gmsh's number of the algorithm "quasi-structured quad"."""
_ATTEMPTS = 3
_ALIKE = 1.15
"""Ratio of two numbers of cells that count as the same."""


def run(seed: int, quick: bool, update: Update, seconds: float = SECONDS) -> dict[str, Any]:
    """All twenty parts; quick: two, a tenth of the time."""
    policy = policy_files.load(policy_files.shipped("quad")[0])
    time_each = 0.1 * seconds if quick else seconds
    parts = list(block_parts().items())
    rows = {}
    for number, (name, domain) in enumerate(parts[:QUICK] if quick else parts):
        update(number, name)
        rows[name] = solved(domain, policy, BlockSearch(time_each, seed=seed))
    return {**summary(list(rows.values())), "shapes": rows}


def solved(
    domain: Domain, policy: policy_files.Policy, search: BlockSearch, cells: int = CELLS
) -> dict[str, Any]:
    """Return one row of the table."""
    began = time.perf_counter()
    mesh = decomposed(meshing.mesh_domain(domain, "quad"), policy, search)
    searched = time.perf_counter()
    grid = block_grid(mesh, Sizing(size=float(np.sqrt(domain.area / cells))))
    divided = time.perf_counter()
    quality = grid.quality
    row = {
        "s*": mesh.optimum,
        "s": mesh.score,
        "blocks": mesh.n_elements,
        "tutorial": TUTORIAL_BLOCKS.get(domain.name, ""),
        "cells": grid.cell_count,
        "worst Jacobian": round(quality.worst_scaled_jacobian, 3),
        "inverted": quality.inverted,
        "aspect": round(quality.worst_aspect, 1),
        "off the curves": float(f"{off_curves(grid):.1e}"),
        "formats": " ".join(_written(grid)),
        "search": round(searched - began, 2),
        "grid": round(divided - searched, 2),
        "writing": round(time.perf_counter() - divided, 2),
    }
    return {**row, **_peer(grid)}


def off_curves(grid: BlockGrid) -> float:
    """The largest distance of a boundary vertex from its curve, in sizes of the domain."""
    structure: BlockStructure = grid.structure
    from meshwright_core.core.composite_curves import nearest_on

    worst = 0.0
    for patch in structure.patches:
        for edge in patch.edges.tolist():
            for at in grid.points[grid.edge_vertices(edge)]:
                curve = int(structure.parts.curve[edge])
                _, squared = nearest_on(structure.parts.curves, curve, at)
                worst = max(worst, float(np.sqrt(squared)))
    return worst / float(np.ptp(structure.points, axis=0).max())


def _written(grid: BlockGrid) -> list[str]:
    """The formats that the grid was written in; those whose packages are missing are left out."""
    done = []
    with tempfile.TemporaryDirectory() as folder:
        for form in FORMATS:
            path = Path(folder) / (form if not form.startswith(".") else f"part{form}")
            try:
                write_blocks(path, grid)
            except MeshError as error:
                if "not installed" not in str(error):
                    raise
                continue
            done.append(form.lstrip("."))
    return done


def _peer(grid: BlockGrid) -> dict[str, Any]:
    """Gmsh's quasi-structured mesh of the same outlines and interfaces; its size is set anew until
    it has about as many cells.
    """
    if importlib.util.find_spec("gmsh") is None:
        return {}
    import gmsh

    size = 2.0 * float(np.sqrt(grid.quality.areas.mean()))  # it cuts each quad in four
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "part.geo"
        path.write_text(_outline(grid), encoding="utf-8")
        for attempt in range(_ATTEMPTS):
            gmsh.initialize(interruptible=False)
            try:
                gmsh.option.setNumber("General.Terminal", 0)
                began = time.perf_counter()
                gmsh.open(str(path))
                gmsh.option.setNumber("Mesh.MeshSizeMin", size)
                gmsh.option.setNumber("Mesh.MeshSizeMax", size)
                gmsh.option.setNumber("Mesh.Algorithm", _PEER)
                gmsh.model.mesh.generate(2)
                found = _measured(gmsh.model.mesh)
                seconds = round(time.perf_counter() - began, 2)
            except Exception as error:  # what it cannot mesh is a result, too
                return {"Gmsh: cells": f"failed ({type(error).__name__})"}
            finally:
                gmsh.finalize()
            many = found["Gmsh: cells"] / grid.cell_count
            if attempt == _ATTEMPTS - 1 or 1.0 / _ALIKE < many < _ALIKE or not many:
                break
            size *= float(np.sqrt(many))
    return {**found, "Gmsh: s": seconds}


def _measured(mesh: Any) -> dict[str, Any]:
    _, elements, _ = mesh.getElements(2)
    tags = np.concatenate(elements) if len(elements) else np.zeros(0)
    worst = min(mesh.getElementQualities(tags, "minSJ")) if len(tags) else 0.0
    return {"Gmsh: cells": len(tags), "Gmsh: worst Jacobian": round(float(worst), 3)}


def _outline(grid: BlockGrid) -> str:
    """The geometry without its blocks: a surface for each region. Without grading each block edge
    is one curve, which has its number.
    """
    structure = grid.structure
    region = np.where(structure.neighbours >= 0, structure.region[structure.neighbours], -1)
    outer = np.flatnonzero(region[:, 0] != region[:, 1])
    kept = [
        line
        for line in geo_text(grid).splitlines()
        if line.startswith("Point(")
        or (line.startswith(("Line(", "Circle(", "Spline(")) and _numbered(line) - 1 in outer)
    ]
    loops = 0
    for number in range(len(structure.region_names)):
        own = outer[(region[outer] == number).any(axis=1)]
        ahead = region[own, 0] == number
        ends = np.where(ahead[:, None], structure.edges[own], structure.edges[own, ::-1])
        curve = np.where(ahead, own + 1, -(own + 1)).tolist()
        leaving = {start: row for row, start in enumerate(ends[:, 0].tolist())}
        first = loops + 1
        while leaving:
            row = next(iter(leaving.values()))
            loop = []
            while (start := int(ends[row, 0])) in leaving:
                del leaving[start]
                loop.append(curve[row])
                row = leaving.get(int(ends[row, 1]), row)
            loops += 1
            kept.append(f"Curve Loop({loops}) = {{{', '.join(map(str, loop))}}};")
        listed = ", ".join(map(str, range(first, loops + 1)))
        kept.append(f"Plane Surface({number + 1}) = {{{listed}}};")
    return "\n".join(kept) + "\n"


def _numbered(line: str) -> int:
    return int(line[line.index("(") + 1 : line.index(")")])


def summary(rows: list[dict[str, Any]]) -> dict[str, Any]:
    """How many are at the optimum, valid, good, on the curves."""
    return {
        "parts": len(rows),
        "at s*": sum(row["s"] == row["s*"] for row in rows),
        "not inverted": sum(not row["inverted"] for row in rows),
        f"worst Jacobian at least {GOOD}": sum(row["worst Jacobian"] >= GOOD for row in rows),
        "on the curves": sum(row["off the curves"] <= 1e-9 for row in rows),
        "no more blocks than the tutorial": sum(
            row["blocks"] <= row["tutorial"] for row in rows if row["tutorial"]
        ),
        "tutorials": sum(bool(row["tutorial"]) for row in rows),
    }


def text(results: dict[str, Any]) -> str:
    """Return the results as a table with its summary below."""
    shapes = results["shapes"]
    columns = list(dict.fromkeys(name for row in shapes.values() for name in row))
    rows = [["part", *columns]]
    rows += [
        [name, *(shown(row.get(column, "")) for column in columns)] for name, row in shapes.items()
    ]
    lines = [f"{name}: {value}" for name, value in results.items() if name != "shapes"]
    return "\n".join([aligned(rows), *lines])
