"""``meshwright mesh``: make a mesh of a shape and write it to a file."""

from __future__ import annotations

import argparse
import time
from typing import Any

from meshwright.cli import arguments as inputs
from meshwright.cli import mesh_input, mesh_output
from meshwright.console import Report

SUMMARY = "make a triangle or quad mesh of a shape and write it to a file"
DESCRIPTION = (
    "Mesh a shape of the gallery, or the shape in a file: a drawing (.dxf, .svg), geometry "
    "(.geojson, .wkt, .poly of Triangle), coordinates of an airfoil (.dat), or JSON as "
    '{"outline": [[x, y], ...], "holes": [[[x, y], ...], ...]}; and write the mesh. Curves stay '
    "curves. Regions that touch are meshed together."
)


SMOOTHED = 10_000
"""Elements up to which a new mesh is smoothed; larger ones only if an element is inverted, since
with many curved sides smoothing takes longer than all the rest."""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments."""
    parser.add_argument("shape", metavar="SHAPE-or-FILE", help="name of a shape, or file")
    parser.add_argument("-o", "--output", metavar="OUT", required=True, help="mesh file to write")
    parser.add_argument(
        "--kind", choices=("tri", "quad"), default="quad", help="triangles or quads (quad)"
    )
    parser.add_argument(
        "--max-edge",
        metavar="H",
        type=inputs.positive_float,
        help="no edge longer than this, in the units of the shape",
    )
    mesh_input.add_drawing_arguments(parser)
    parser.add_argument("--seed", metavar="N", type=inputs.seed, default=0, help="random seed (0)")


def run(arguments: argparse.Namespace, report: Report) -> None:
    """Make the mesh, smooth and untangle it, write it; `from_elements` has validated it."""
    from meshwright.document.position_repair import settle
    from meshwright_core.geometry import quality

    output = mesh_output.checked_mesh_output(arguments.output, arguments.kind)
    domain = mesh_input.read_domain(arguments.shape, arguments)
    start = time.perf_counter()
    with report.progress(f"meshing {domain.name or arguments.shape}"):
        mesh = inputs.make_mesh(
            domain, arguments.kind, arguments.max_edge, arguments.seed, arguments.time_limit
        )
        small = mesh.n_elements <= SMOOTHED
        inverted = settle(mesh) if small or len(quality.inverted(mesh)) else []
    mesh_input.note_mended(arguments.shape, arguments, report)
    mesh_output.write_mesh(output, mesh)
    values = {
        "command": "mesh",
        "shape": arguments.shape,
        "output": str(output),
        "kind": mesh.kind,
        "vertices": mesh.n_vertices,
        "elements": mesh.n_elements,
        "corners": int(mesh.geometric()[mesh.vertices()].sum()),
        "score": mesh.score,
        "optimum": mesh.optimum,
        **mesh_output.measures(mesh),
        "inverted_elements": len(inverted),
        "inverted_ids": inverted,
        "seconds": round(time.perf_counter() - start, 3),
    }
    report.result(values, _text(values))


def _text(values: dict[str, Any]) -> str:
    elements = mesh_output.counted(values["elements"], values["kind"])
    text = (
        f"{values['output']}: {elements}, {values['vertices']:,} vertices, "
        f"s = {values['score']}, s* = {values['optimum']}, area {values['area']:.10g}"
    )
    text += mesh_output.inverted_words(values["inverted_ids"], lead="; ")
    regions = mesh_output.region_words(values)
    return f"{text}\n  {regions}" if regions else text
