"""The mesh that a command starts from: a mesh file, perhaps on the curves of a drawing, or the mesh
of a drawing.
"""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

from meshwright.cli import arguments as inputs
from meshwright.console import Report, UserError

if TYPE_CHECKING:
    from meshwright_core import HalfEdgeMesh
    from meshwright_core.domains.domain import Domain


def add_geometry_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments that :func:`read_mesh` reads."""
    parser.add_argument(
        "--kind", choices=("tri", "quad"), help="elements that a drawing is meshed with (quad)"
    )
    parser.add_argument(
        "--max-edge",
        metavar="H",
        type=inputs.positive_float,
        help="no edge of the first mesh of a drawing is longer; as coarse as the shape allows "
        "where it is left out",
    )
    parser.add_argument(
        "--part",
        metavar="NAME",
        help="take this part of a mesh file alone, by its name or number: a zone, piece or "
        "instance, or a connected component",
    )
    parser.add_argument(
        "--to-quads",
        action="store_true",
        help="make quads of the triangles of a mesh file: in pairs, and if some are left all "
        "elements are split",
    )
    parser.add_argument(
        "--geometry",
        metavar="DRAWING",
        help="the boundary of the mesh lies on the curves of this drawing and stays on them",
    )
    add_drawing_arguments(parser)


def add_drawing_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments that say how drawings, and boundaries of mesh files, are read."""
    parser.add_argument(
        "--region",
        metavar="NAME",
        help="take this region of a drawing, by its name or number (see shapes FILE), several with "
        "commas between them, or all; by default all that touch",
    )
    add_tracing_arguments(parser)
    parser.add_argument(
        "--curve-step",
        metavar="DEGREES",
        type=inputs.angle,
        help="an edge along a curve of a drawing turns by no more; as much as the shape allows "
        "where it is left out",
    )
    parser.add_argument(
        "--fit-arcs",
        action="store_true",
        help="find arcs in polylines, of a drawing or of the boundary of a mesh file",
    )


def add_tracing_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments that say what is found in a drawing."""
    parser.add_argument(
        "--gap",
        metavar="WIDTH",
        type=inputs.length,
        help="close gaps of a drawing up to this width, in its units (0.001 of its size)",
    )
    parser.add_argument(
        "--corner-angle",
        metavar="DEGREES",
        type=inputs.angle,
        help="a boundary vertex is a corner where the boundary turns by more (0.01, or 1 beside a "
        "curve); raise it where curved sides are drawn as short straight pieces",
    )
    parser.add_argument(
        "--time-limit",
        metavar="SECONDS",
        type=inputs.positive_float,
        help="processor time that reading a drawing may take, and that meshing it may take (30)",
    )


def is_mesh(word: str) -> bool:
    """Whether an input is a mesh file, and no drawing and no name of a shape."""
    from meshwright.document.storage.document_file import is_drawing
    from meshwright.sources import resolve

    return resolve.names_file(word) and not is_drawing(word)


def read_mesh(arguments: argparse.Namespace, report: Report) -> HalfEdgeMesh:
    """Return the mesh in a mesh file, on its geometry, or the mesh of a drawing or a shape.

    ``report`` notes what was mended in a drawing, and what was left out. Raises UserError with the
    reason.
    """
    word = arguments.input
    if not is_mesh(word):
        if arguments.geometry is not None:
            raise UserError(f"--geometry {arguments.geometry}: {word} is itself a shape, no mesh")
        for option in ("part", "to_quads"):
            if getattr(arguments, option):
                name = option.replace("_", "-")
                raise UserError(f"--{name}: this is for mesh files, and {word} is a shape")
        domain, kind = read_domain(word, arguments), arguments.kind or "quad"
        seconds = arguments.time_limit
        mesh = inputs.make_mesh(domain, kind, arguments.max_edge, arguments.seed, seconds)
        note_mended(word, arguments, report)
        return mesh
    for option in ("kind", "max_edge", "region", "gap", "curve_step", "time_limit"):
        drawn = option in ("region", "gap", "time_limit") and arguments.geometry is not None
        if getattr(arguments, option) is not None and not drawn:
            name = option.replace("_", "-")
            raise UserError(f"--{name}: this is for drawings, and {word} is a mesh")
    mesh = inputs.read_mesh(word, arguments.corner_angle, arguments.part, arguments.to_quads)
    if arguments.geometry is not None:
        mesh = _on_drawing(word, mesh, read_domain(arguments.geometry, arguments))
        note_mended(arguments.geometry, arguments, report)
        return mesh
    if arguments.fit_arcs:
        return _with_arcs(word, mesh, arguments.corner_angle)
    return mesh


def read_domain(word: str, arguments: argparse.Namespace) -> Domain:
    """Return the domain that a gallery name or a drawing means, as the arguments say."""
    return inputs.read_domain(
        word,
        arguments.corner_angle,
        arguments.curve_step,
        arguments.region,
        arguments.gap,
        "arcs" if arguments.fit_arcs else None,
        arguments.time_limit,
    )


def note_mended(word: str, arguments: argparse.Namespace, report: Report) -> None:
    """Note what was mended in a DXF or SVG drawing that has just been read, and what was left out;
    other inputs are passed over.
    """
    if Path(word).suffix.lower() not in (".dxf", ".svg"):
        return
    from meshwright_core.core.irregularity import CORNER_ANGLE
    from meshwright_core.io import drawings

    angle = CORNER_ANGLE if arguments.corner_angle is None else arguments.corner_angle
    found = drawings.read_regions(word, angle, arguments.gap)  # known from the last reading
    for sentence in (*found.repairs, *found.ignored):
        report.note(f"{word}: {sentence}")


def _on_drawing(word: str, mesh: HalfEdgeMesh, domain: Domain) -> HalfEdgeMesh:
    from meshwright_core.domains import mesh_on_domain

    with inputs.bad_input(word):
        return mesh_on_domain.placed(mesh, domain)


def _with_arcs(word: str, mesh: HalfEdgeMesh, corner_angle: float | None) -> HalfEdgeMesh:
    from meshwright_core.domains import arc_fitting

    with inputs.bad_input(word):
        return arc_fitting.mesh_with_arcs(mesh, corner_angle)
