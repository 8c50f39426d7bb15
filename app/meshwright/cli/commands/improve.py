"""``meshwright improve``: let a policy work on the connectivity of a mesh, or of a drawing."""

from __future__ import annotations

import argparse
import time
from contextlib import ExitStack
from pathlib import Path
from typing import TYPE_CHECKING, Any

from meshwright.cli import arguments as inputs
from meshwright.cli import mesh_input, mesh_output
from meshwright.cli.output_files import checked_output, replacing
from meshwright.console import Report, table

if TYPE_CHECKING:
    from meshwright_agent.search.annealing import Operations
    from meshwright_agent.search.solver import Solution
    from meshwright_core import HalfEdgeMesh

SUMMARY = "let a trained policy improve the connectivity of a mesh file or a drawing"
DESCRIPTION = (
    "Read a mesh of triangles or of quads, or mesh a drawing coarsely; let a policy change its "
    "connectivity until no vertex is more irregular than it must be, smooth it, and write it. "
    "Corners stay where they are, and every other boundary vertex stays on its own side of the "
    "outline. Curved sides stay curves: those of a drawing, and those that --geometry or "
    "--fit-arcs finds for a mesh. A valid mesh never becomes an invalid one; where the input has "
    "inverted elements and the result still has, the exit code is 3."
)

ROLLOUTS = 10
EARLIER = 8
"""The number of parts of a run between which it may end earlier, to keep a mesh valid."""
PICTURE_SIZE = (1200, 900)
STILL_INVERTED = 3
"""The exit code where elements were inverted before and still are."""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments."""
    parser.add_argument(
        "input", metavar="IN", help="mesh file, drawing, or name of a shape, to read"
    )
    parser.add_argument("-o", "--output", metavar="OUT", required=True, help="mesh file to write")
    effort = parser.add_mutually_exclusive_group()
    effort.add_argument(
        "--rollouts",
        metavar="K",
        type=inputs.positive_int,
        help=f"run the policy K times and keep the best ({ROLLOUTS})",
    )
    effort.add_argument(
        "--search",
        metavar="SECONDS",
        type=inputs.positive_float,
        help="run the policy repeatedly for this time and keep the best",
    )
    parser.add_argument(
        "--steps", metavar="N", type=inputs.positive_int, help="at most N operations in a run"
    )
    parser.add_argument("--seed", metavar="N", type=inputs.seed, default=0, help="random seed (0)")
    parser.add_argument(
        "--policy", metavar="P", help="name of a shipped policy, or a policy file (the shipped one)"
    )
    parser.add_argument("--png", metavar="P.png", help="also write a picture of the result")
    parser.add_argument("--film", metavar="F", help="also write the run as a film, F.gif or F.mp4")
    mesh_input.add_geometry_arguments(parser)


def run(arguments: argparse.Namespace, report: Report) -> int | None:
    """Check the inputs, then search, apply the result, smooth and untangle, write."""
    from meshwright_core.core.score import normalised_return
    from meshwright_core.geometry import quality

    mesh_output.checked_mesh_output(arguments.output)
    png = checked_output(arguments.png, (".png",), "--png") if arguments.png else None
    film = checked_output(arguments.film, (".gif", ".mp4"), "--film") if arguments.film else None
    start = mesh_input.read_mesh(arguments)
    output = mesh_output.checked_mesh_output(arguments.output, start.kind)
    policy = inputs.read_policy(arguments.policy, start.kind)

    inputs.prepare_agent(report)
    began = time.perf_counter()
    sound = not len(quality.inverted(start))
    solution = _search(arguments, report, start, policy)
    mesh, operations, inverted = _improved(start, solution, sound)
    mesh.validate()
    if mesh.optimum != start.optimum:
        raise RuntimeError(f"s* changed from {start.optimum} to {mesh.optimum}")
    with (
        ExitStack() as stack
    ):  # all files or none: the others replace their targets after the mesh is written
        if png is not None:
            _write_picture(stack.enter_context(replacing(png)), mesh)
        if film is not None:
            temporary = stack.enter_context(replacing(film))
            name = Path(arguments.input).stem
            _write_film(temporary, start, operations, policy.name, name, report)
        mesh_output.write_mesh(output, mesh)

    values = {
        "command": "improve",
        "input": arguments.input,
        "output": str(output),
        "png": str(png) if png else None,
        "film": str(film) if film else None,
        "policy": policy.name,
        "kind": mesh.kind,
        "score_before": start.score,
        "score_after": mesh.score,
        "optimum": mesh.optimum,
        "at_optimum": mesh.score == mesh.optimum,
        "normalised_return": normalised_return(start.score, mesh.score, mesh.optimum),
        "elements_before": start.n_elements,
        "elements": mesh.n_elements,
        "vertices": mesh.n_vertices,
        **mesh_output.measures(mesh),
        "inverted_elements": len(inverted),
        "inverted_ids": inverted,
        "operations": len(operations),
        "rollouts": solution.rollouts,
        "seconds": round(time.perf_counter() - began, 3),
    }
    report.result(values, _text(values))
    if not inverted:
        return None
    count = "1 element is" if len(inverted) == 1 else f"{len(inverted):,} elements are"
    report.note(f"meshwright improve: {output}: {count} still inverted")
    return STILL_INVERTED


def _improved(
    start: HalfEdgeMesh, solution: Solution, sound: bool
) -> tuple[HalfEdgeMesh, Operations, list[int]]:
    """The improved mesh, the operations that lead to it, and the elements that stay inverted.

    ``start`` is not changed. If it is ``sound`` the result is so too: where smoothing cannot
    straighten all elements at the end of the search, it is the best of some states on the way.
    """
    from meshwright.document.position_repair import settle

    mesh = start.copy()
    inverted = [] if solution.carry_out(mesh) else settle(mesh)
    if not (inverted and sound):
        return mesh, solution.operations, inverted
    best, done = start.copy(), 0
    count = len(solution.operations)
    for stop in sorted({count * share // EARLIER for share in range(1, EARLIER)}):
        mesh = start.copy()
        for operation, halfedge in solution.operations[:stop]:
            mesh.apply(operation, halfedge)
        if mesh.score <= best.score and not settle(mesh):
            best, done = mesh, stop
    return best, solution.operations[:done], []


def _write_picture(path: Path, mesh: HalfEdgeMesh) -> None:
    from meshwright.graphics.export import export_job
    from meshwright.graphics.mesh_figure import FigureOptions

    export_job.save_mesh_picture(mesh, path, FigureOptions(PICTURE_SIZE))


def _write_film(
    path: Path, mesh: HalfEdgeMesh, operations: Operations, by: str, name: str, report: Report
) -> None:
    """Write the operations as a film; ``mesh`` is in the state before the search."""
    from meshwright.graphics.export import export_job
    from meshwright.graphics.export.film import Film

    film = Film.of_run(mesh, operations, by, name)
    order = export_job.ExportOptions(ending=path.suffix.lower())
    with report.progress("filming", len(film.stops(order.stride(film)))) as update:
        export_job.save_export(film, order, path, lambda done, total: update(done))


def _search(
    arguments: argparse.Namespace, report: Report, mesh: HalfEdgeMesh, policy: Any
) -> Solution:
    from meshwright_agent.search import solver

    rollouts = None if arguments.search else arguments.rollouts or ROLLOUTS
    with report.progress("searching", rollouts) as update:
        return solver.solve(
            mesh,
            policy,
            rollouts=rollouts,
            seconds=arguments.search,
            max_steps=arguments.steps,
            seed=arguments.seed,
            progress=lambda done, best: update(done, f"s = {best}, s* = {mesh.optimum}"),
        )


def _text(values: dict[str, Any]) -> str:
    s = f"{values['score_before']} -> {values['score_after']}, s* = {values['optimum']}"
    if values["at_optimum"]:
        s += ", at the optimum"
    elements = mesh_output.counted(values["elements"], values["kind"])
    rows = [
        ("s", s),
        ("elements", f"{values['elements_before']:,} -> {elements}"),
        *mesh_output.measure_rows(values),
        ("inverted", mesh_output.inverted_words(values["inverted_ids"]) or "none"),
        ("operations", f"{values['operations']} (best of {values['rollouts']})"),
        ("seconds", f"{values['seconds']:.1f}"),
    ]
    files = (values["output"], values["png"], values["film"])
    written = ", ".join(file for file in files if file)
    return f"{values['input']} -> {written}\n" + table(rows)
