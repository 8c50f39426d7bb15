"""``meshwright info``: what is in a mesh file, a project, or the mesh of a shape."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING, Any

from meshwright.cli import arguments as inputs
from meshwright.cli import mesh_output
from meshwright.console import Report, UserError, table

if TYPE_CHECKING:
    from meshwright_core import HalfEdgeMesh

SUMMARY = "say what is in a mesh file: elements, score, names of sides and regions"
DESCRIPTION = (
    "List the numbers of a mesh file or project, and the names of its sides and regions with their "
    "sizes. What of the file is not kept is said on stderr, a line each."
)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments."""
    parser.add_argument("file", metavar="FILE", help="mesh file or project")
    parser.add_argument(
        "--to",
        metavar="OUT",
        help="also say what a file of this name, or ending, cannot hold of the names",
    )


def run(arguments: argparse.Namespace, report: Report) -> None:
    """Read the file and list what is in it."""
    from meshwright_core.errors import MeshError
    from meshwright_core.io import mesh_files

    mesh = inputs.read_mesh(arguments.file)
    values: dict[str, Any] = {
        "command": "info",
        "file": arguments.file,
        "kind": mesh.kind,
        "elements": mesh.n_elements,
        "vertices": mesh.n_vertices,
        "loops": len(mesh.boundary_loops()),
        "score": mesh.score,
        "optimum": mesh.optimum,
        "sides": _sides(mesh),
        **mesh_output.measures(mesh),
        "not_kept": list(mesh.left_out),
    }
    values.setdefault("regions", _only_region(values, mesh))
    if arguments.to is not None:
        try:
            values["lost"] = list(mesh_files.losses(arguments.to, mesh))
        except MeshError as error:
            raise UserError(f"--to {arguments.to}: {error}") from error
    report.result(values, _text(values))


def _sides(mesh: HalfEdgeMesh) -> list[dict[str, Any]]:
    import numpy as np

    rows = []
    for name, ends in sorted(mesh.sides().items()):
        length = np.linalg.norm(np.diff(mesh.points[ends], axis=1), axis=2).sum()
        rows.append({"name": name, "edges": len(ends), "length": float(length)})
    return rows


def _only_region(values: dict[str, Any], mesh: HalfEdgeMesh) -> list[dict[str, Any]]:
    name = mesh.region_names[0]
    return [{"name": name, "elements": values["elements"], "area": values["area"]}] if name else []


def _text(values: dict[str, Any]) -> str:
    rows = [
        ("elements", mesh_output.counted(values["elements"], values["kind"])),
        ("vertices", f"{values['vertices']:,}"),
        ("boundary", f"{values['loops']} loop{'' if values['loops'] == 1 else 's'}"),
        ("s", f"{values['score']}, s* = {values['optimum']}"),
        ("area", f"{values['area']:.10g}"),
    ]
    for side in values["sides"]:
        words = f"{side['edges']} edge{'' if side['edges'] == 1 else 's'}"
        rows.append(
            ("side", f"{side['name'] or '(no name)'}: {words}, length {side['length']:.6g}")
        )
    for number, region in enumerate(values["regions"], start=1):
        words = mesh_output.counted(region["elements"], values["kind"])
        name = region["name"] or f"(region {number})"
        rows.append(("region", f"{name}: {words}, area {region['area']:.6g}"))
    lines = [values["file"], table(rows)]
    lines += [f"not kept: {phrase}" for phrase in values["not_kept"]]
    lines += [f"lost: {line}" for line in values.get("lost", ())]
    return "\n".join(lines)
