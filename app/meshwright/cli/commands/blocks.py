"""``meshwright blocks``: from a drawing or a mesh to a block-structured grid."""

from __future__ import annotations

import argparse
import time
from pathlib import Path
from typing import TYPE_CHECKING, Any

from meshwright.cli import arguments as inputs
from meshwright.cli import grid_options, mesh_input, mesh_output
from meshwright.cli.output_files import checked_output
from meshwright.console import Report, UserError, table

if TYPE_CHECKING:
    from meshwright_core import HalfEdgeMesh
    from meshwright_core.blocks.grid import BlockGrid

SUMMARY = "make a block-structured grid of a drawing or a mesh, for a solver to read"
DESCRIPTION = (
    "Decompose a drawing into few blocks, or take the quads of a mesh as blocks; divide them with "
    "equal numbers of cells along every chord, with layers at walls, on the true curves; and write "
    "the grid: for OpenFOAM (a file called blockMeshDict), Gmsh (.geo, .msh), Plot3D (.xyz as "
    "text, .p3d binary, with a neutral map .nmf), CGNS (.cgns), VTK (.vtm), or as a mesh of quads "
    "in any format of meshes. Sides and regions keep their names. "
    "For a project, numbers of cells and layers count that were set in the window. Where cells "
    "stay inverted the exit code is 3."
)

SECONDS = 10.0
"""Search time for a drawing where none is given."""
STILL_INVERTED = 3


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments."""
    parser.add_argument(
        "input", metavar="IN", help="drawing, name of a shape, or mesh file, to read"
    )
    parser.add_argument("-o", "--output", metavar="OUT", required=True, help="file to write")
    add_own_arguments(parser)


def add_own_arguments(parser: argparse.ArgumentParser) -> None:
    """Add all arguments but the files, for a command that makes many grids."""
    grid_options.add_grid_arguments(parser)
    parser.add_argument(
        "--search", metavar="SECONDS", type=inputs.length,
        help="look for better blocks for this time; 0 for none "
        f"({SECONDS:g} for a drawing, 0 for a mesh)",
    )  # fmt: skip
    parser.add_argument(
        "--prefer", choices=("blocks", "balanced", "shape"), default="balanced",
        help="among decompositions of equal s: few blocks, a good shape and then few blocks, or "
        "the best shape (balanced)",
    )  # fmt: skip
    parser.add_argument(
        "--min-shape", metavar="X", type=inputs.share,
        help="worst scaled Jacobian of a block, 0 to 1, beyond which only their number counts",
    )  # fmt: skip
    parser.add_argument(
        "--policy", metavar="P", help="name of a shipped policy, or a policy file (the shipped one)"
    )
    parser.add_argument("--seed", metavar="N", type=inputs.seed, default=0, help="random seed (0)")
    mesh_input.add_geometry_arguments(parser)


def run(arguments: argparse.Namespace, report: Report) -> int | None:
    """Check the inputs, search, make the grid, write it."""
    from meshwright_core.blocks.grid import BlockStructure, block_grid
    from meshwright_core.blocks.sizing import Sizing, division
    from meshwright_core.errors import MeshError
    from meshwright_core.io.grids.block_files import losses, write_blocks

    output = _checked(arguments)
    sizing, extrusion = grid_options.sizing(arguments), grid_options.extrusion(arguments)
    if arguments.kind == "tri":
        raise UserError("--kind tri: blocks are of quads")
    start = mesh_input.read_mesh(arguments, report)
    if start.kind != "quad":
        raise UserError(f"{arguments.input}: a mesh of triangles has no blocks")
    began = time.perf_counter()
    with inputs.bad_input(arguments.input):
        # sides that do not exist are noticed before the search
        blocks = BlockStructure.of(start)
        division(blocks, sizing)
    mesh, searched = _decomposed(arguments, report, start)
    with inputs.bad_input(arguments.input):
        if mesh is start:
            sizing = sizing.over(Sizing.planned(blocks, start.grid_plan))
    with inputs.bad_input(arguments.input), report.progress("dividing"):
        grid = block_grid(mesh, sizing)
    made = time.perf_counter()
    try:
        walls = tuple(wall.name for wall in sizing.walls)
        files = write_blocks(output, grid, arguments.order, extrusion, walls)
    except MeshError as error:
        raise UserError(str(error)) from error
    values = {
        "command": "blocks",
        "input": arguments.input,
        "output": str(output),
        "files": [str(file) for file in files],
        **grid_values(grid),
        "remarks": list(grid.remarks),
        "order": arguments.order,
        "search_seconds": round(searched, 3),
        "grid_seconds": round(made - began - searched, 3),
        "seconds": round(time.perf_counter() - began, 3),
    }
    report.result(values, _text(values))
    for sentence in (*grid.remarks, *losses(output, grid)):
        report.note(f"meshwright blocks: {output}: {sentence}")
    if not values["inverted_elements"]:
        return None
    report.note(f"meshwright blocks: {output}: {values['inverted_elements']:,} cells are inverted")
    return STILL_INVERTED


def grid_values(grid: BlockGrid) -> dict[str, Any]:
    """What the JSON of a command says of a grid."""
    from meshwright_core.geometry import quality
    from meshwright_core.geometry.shape_bound import shape_bound

    structure, measured = grid.structure, grid.quality
    mesh = structure.mesh
    faces = grid.patch_faces()
    return {
        "blocks": len(structure.corners),
        "chords": structure.chord_count,
        "cells": grid.cell_count,
        "vertices": len(grid.points),
        "score": mesh.score,
        "optimum": mesh.optimum,
        "at_optimum": mesh.score == mesh.optimum,
        "shape_bound": float(shape_bound(mesh)),
        "worst_block_scaled_jacobian": float(quality.scaled_jacobian(mesh).min()),
        "worst_scaled_jacobian": measured.worst_scaled_jacobian,
        "inverted_elements": measured.inverted,
        "worst_aspect_ratio": measured.worst_aspect,
        "non_orthogonality": measured.non_orthogonality,
        "growth": measured.growth,
        "area": float(measured.areas.sum()),
        "counts": grid.division.counts.tolist(),
        "patches": [{"name": name, "cells": len(rows)} for name, rows in faces.items()],
        "regions": list(structure.region_names),
    }


def _checked(arguments: argparse.Namespace) -> Path:
    """The output path, where the options and the format fit together."""
    from meshwright_core.errors import MeshError
    from meshwright_core.io.grids.block_files import check_format

    output = checked_output(arguments.output)
    try:
        check_format(output, arguments.order, bool(arguments.extrude or arguments.wedge))
    except MeshError as error:
        raise UserError(f"-o {arguments.output}: {str(error).rstrip('.')}") from error
    return output


def _decomposed(
    arguments: argparse.Namespace, report: Report, start: HalfEdgeMesh
) -> tuple[HalfEdgeMesh, float]:
    """The blocks and the seconds of the search."""
    from meshwright.document.storage.document_file import is_drawing
    from meshwright.sources import resolve

    word = arguments.input
    drawn = not resolve.names_file(word) or is_drawing(word)
    seconds = (SECONDS if drawn else 0.0) if arguments.search is None else arguments.search
    if not seconds:
        return start, 0.0
    from meshwright.assistant.block_search import BlockSearch, decomposed

    policy = inputs.read_policy(arguments.policy, start.kind)
    inputs.prepare_agent(report)
    search = BlockSearch(seconds, arguments.prefer, arguments.min_shape, arguments.seed)
    began = time.perf_counter()
    with report.progress("searching") as update:
        mesh = decomposed(
            start, policy, search,
            lambda done, best: update(done, f"s = {best}, s* = {start.optimum}"),
        )  # fmt: skip
    return mesh, time.perf_counter() - began


def _text(values: dict[str, Any]) -> str:
    s = f"{values['score']}, s* = {values['optimum']}"
    if values["at_optimum"]:
        s += ", at the optimum"
    patches = ", ".join(f"{patch['name']} {patch['cells']:,}" for patch in values["patches"])
    rows = [
        ("blocks", f"{values['blocks']:,}, in {values['chords']:,} chords"),
        ("s", s),
        ("cells", mesh_output.counted(values["cells"], "quad")),
        ("worst cell", f"scaled Jacobian {values['worst_scaled_jacobian']:.2f}, aspect ratio "
                       f"{values['worst_aspect_ratio']:.1f}"),
        ("solvers' checks", f"non-orthogonality {values['non_orthogonality']:.0f} degrees, growth "
                            f"{values['growth']:.2f}"),
        ("inverted", f"{values['inverted_elements']:,}" if values["inverted_elements"] else "none"),
        ("sides", patches),
        ("seconds", f"{values['seconds']:.1f}"),
    ]  # fmt: skip
    return f"{values['input']} -> {', '.join(values['files'])}\n" + table(rows)
