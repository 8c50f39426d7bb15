"""``meshwright improve``: let a policy work on the connectivity of a mesh file."""

from __future__ import annotations

import argparse
import time
from contextlib import ExitStack
from pathlib import Path
from typing import TYPE_CHECKING, Any

from meshwright.cli import arguments as inputs
from meshwright.cli import mesh_output
from meshwright.cli.output_files import checked_output, replacing
from meshwright.console import Report, table

if TYPE_CHECKING:
    from meshwright_agent.search.solver import Solution
    from meshwright_core import HalfEdgeMesh

SUMMARY = "let a trained policy improve the connectivity of a mesh file"
DESCRIPTION = (
    "Read a mesh of triangles or of quads, let a policy change its connectivity until no vertex "
    "is more irregular than it must be, smooth it, and write it. Corners stay where they are, "
    "and every other boundary vertex stays on its own side of the outline."
)

ROLLOUTS = 10
PICTURE_SIZE = (1200, 900)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments."""
    parser.add_argument("input", metavar="IN", help="mesh file to read")
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
    parser.add_argument(
        "--corner-angle",
        metavar="DEGREES",
        type=inputs.angle,
        help="a boundary vertex is a corner where the boundary turns by more (0.01); raise it "
        "where curved sides are drawn as short straight pieces",
    )


def run(arguments: argparse.Namespace, report: Report) -> None:
    """Check the inputs, then search, apply the result, smooth and untangle, write."""
    from meshwright.document.position_repair import settle
    from meshwright_core.core.score import normalised_return

    mesh_output.checked_mesh_output(arguments.output)
    png = checked_output(arguments.png, (".png",), "--png") if arguments.png else None
    film = checked_output(arguments.film, (".gif", ".mp4"), "--film") if arguments.film else None
    mesh = inputs.read_mesh(arguments.input, arguments.corner_angle)
    output = mesh_output.checked_mesh_output(arguments.output, mesh.kind)
    policy = inputs.read_policy(arguments.policy, mesh.kind)

    inputs.prepare_agent(report)
    start = time.perf_counter()
    before = {"score": mesh.score, "elements": mesh.n_elements, "optimum": mesh.optimum}
    solution = _search(arguments, report, mesh, policy)
    first = mesh.copy() if film else mesh
    solution.replay(mesh)
    inverted = settle(mesh)
    mesh.validate()
    if mesh.optimum != before["optimum"]:
        raise RuntimeError(f"s* changed from {before['optimum']} to {mesh.optimum}")
    with (
        ExitStack() as stack
    ):  # all files or none: the others replace their targets after the mesh is written
        if png is not None:
            _write_picture(stack.enter_context(replacing(png)), mesh)
        if film is not None:
            temporary = stack.enter_context(replacing(film))
            _write_film(temporary, first, solution, policy.name, Path(arguments.input).stem, report)
        mesh_output.write_mesh(output, mesh)

    values = {
        "command": "improve",
        "input": arguments.input,
        "output": str(output),
        "png": str(png) if png else None,
        "film": str(film) if film else None,
        "policy": policy.name,
        "kind": mesh.kind,
        "score_before": before["score"],
        "score_after": mesh.score,
        "optimum": mesh.optimum,
        "at_optimum": mesh.score == mesh.optimum,
        "normalised_return": normalised_return(before["score"], mesh.score, mesh.optimum),
        "elements_before": before["elements"],
        "elements": mesh.n_elements,
        "vertices": mesh.n_vertices,
        "inverted_elements": len(inverted),
        "inverted_ids": inverted,
        "operations": len(solution.operations),
        "rollouts": solution.rollouts,
        "seconds": round(time.perf_counter() - start, 3),
    }
    report.result(values, _text(values))


def _write_picture(path: Path, mesh: HalfEdgeMesh) -> None:
    from meshwright.graphics.export import export_job
    from meshwright.graphics.mesh_figure import FigureOptions

    export_job.save_mesh_picture(mesh, path, FigureOptions(PICTURE_SIZE))


def _write_film(
    path: Path, mesh: HalfEdgeMesh, solution: Solution, by: str, name: str, report: Report
) -> None:
    """Write the operations as a film; ``mesh`` is in the state before the search."""
    from meshwright.graphics.export import export_job
    from meshwright.graphics.export.film import Film

    film = Film.of_run(mesh, solution.operations, by, name)
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
    from meshwright_core.core.kinds import KIND_NOUN

    s = f"{values['score_before']} -> {values['score_after']}, s* = {values['optimum']}"
    if values["at_optimum"]:
        s += ", at the optimum"
    elements = f"{values['elements_before']} -> {values['elements']}"
    rows = [
        ("s", s),
        ("elements", f"{elements} {KIND_NOUN[values['kind']]}"),
        ("inverted", mesh_output.inverted_words(values["inverted_ids"]) or "none"),
        ("operations", f"{values['operations']} (best of {values['rollouts']})"),
        ("seconds", f"{values['seconds']:.1f}"),
    ]
    files = (values["output"], values["png"], values["film"])
    written = ", ".join(file for file in files if file)
    return f"{values['input']} -> {written}\n" + table(rows)
