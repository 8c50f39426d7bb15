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
from meshwright.console import Report, UserError, table

if TYPE_CHECKING:
    import numpy as np

    from meshwright_agent.search.annealing import Operations
    from meshwright_agent.search.improvement import Improved, Wishes
    from meshwright_core import HalfEdgeMesh

SUMMARY = "let a trained policy improve the connectivity of a mesh file or a drawing"
DESCRIPTION = (
    "Read a mesh of triangles or of quads, or mesh a drawing coarsely; let a policy change its "
    "connectivity until no vertex is more irregular than it must be, and write it. The elements of "
    "a mesh keep their size; a drawing becomes few large quads, its blocks, and so does a mesh "
    "with --blocks. Among meshes of equal s the worst element shape counts, then their number. "
    "Corners stay where they are, and every other boundary vertex stays on its own side of the "
    "outline. Curved sides stay curves: those of a drawing, and those that --geometry or "
    "--fit-arcs finds for a mesh. A valid mesh never becomes an invalid one; where the input has "
    "inverted elements and the result still has, the exit code is 3."
)

ROLLOUTS = 10
CHECKED = 20_000
"""Elements up to which all invariants of the answer are checked; that of more takes seconds."""
LOADING, LEAST = 1.0, 0.5
"""Seconds from the beginning of the command to the search that are not taken off its time; and the
least share of the time that is left to it."""
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
        help="run the policy repeatedly for this time and keep the best; what loading takes beyond "
        "a second is taken off, up to half of the time",
    )
    parser.add_argument(
        "--steps", metavar="N", type=inputs.positive_int, help="at most N operations in a run"
    )
    parser.add_argument("--seed", metavar="N", type=inputs.seed, default=0, help="random seed (0)")
    parser.add_argument(
        "--policy", metavar="P", help="name of a shipped policy, or a policy file (the shipped one)"
    )
    parser.add_argument(
        "--blocks",
        action="store_true",
        help="decompose a quad mesh into blocks; otherwise its elements keep their size",
    )
    parser.add_argument(
        "--prefer",
        choices=("blocks", "balanced", "shape"),
        default="balanced",
        help="among meshes of equal s: few blocks whatever their shape, a good worst shape and "
        "then few blocks, or the best worst shape (balanced)",
    )
    parser.add_argument(
        "--min-shape",
        metavar="X",
        type=inputs.share,
        help="worst scaled Jacobian, 0 to 1, beyond which only the number of blocks counts",
    )
    parser.add_argument(
        "--elements-shape",
        metavar="X",
        type=inputs.share,
        help="divide the blocks until the shape 2J/(a*a + b*b) of every element, which sees the "
        "ratio of its sides, is at least X",
    )
    parser.add_argument("--png", metavar="P.png", help="also write a picture of the result")
    parser.add_argument(
        "--film",
        metavar="F",
        help="also write the run as a film, F.gif or F.mp4; "
        "a mesh that keeps its size is then changed by operations only",
    )
    mesh_input.add_geometry_arguments(parser)


def run(arguments: argparse.Namespace, report: Report) -> int | None:
    """Check the inputs, search, and write the answer."""
    from meshwright_core.core.score import normalised_return
    from meshwright_core.geometry import quality

    mesh_output.checked_mesh_output(arguments.output)
    png = checked_output(arguments.png, (".png",), "--png") if arguments.png else None
    film = checked_output(arguments.film, (".gif", ".mp4"), "--film") if arguments.film else None
    start = mesh_input.read_mesh(arguments, report)
    output = mesh_output.checked_mesh_output(arguments.output, start.kind)
    wishes = _wishes(arguments, start)
    policy = inputs.read_policy(arguments.policy, start.kind)

    inverted_before = len(quality.inverted(start))
    seconds = search_time(arguments.search, report.seconds)
    inputs.prepare_agent(report)
    began = time.perf_counter()
    improved = _search(arguments, report, start, policy, wishes, seconds)
    mesh = improved.mesh
    if mesh.n_elements <= CHECKED:
        mesh.validate()
    if mesh.optimum != start.optimum:
        raise RuntimeError(f"s* changed from {start.optimum} to {mesh.optimum}")
    inverted = _rows(mesh, quality.inverted(mesh))
    with (
        ExitStack() as stack
    ):  # all files or none: the others replace their targets after the mesh is written
        if png is not None:
            _write_picture(stack.enter_context(replacing(png)), mesh)
        if film is not None:
            temporary = stack.enter_context(replacing(film))
            name = Path(arguments.input).stem
            _write_film(temporary, start, improved.operations, policy.name, name, report)
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
        "target_scaled_jacobian": improved.target,
        "prefer": arguments.prefer,
        "inverted_before": inverted_before,
        "inverted_elements": len(inverted),
        "inverted_ids": inverted,
        "size_kept": improved.size_kept,
        "divided": improved.divided,
        "method": improved.method,
        "operations": len(improved.operations),
        "rollouts": improved.rollouts,
        "reason": improved.reason,
        "seconds": round(time.perf_counter() - began, 3),
    }
    report.result(values, _text(values))
    if not inverted:
        if inverted_before:
            count = _counted(inverted_before, "was", "were")
            report.note(f"meshwright improve: {arguments.input}: {count} inverted; none is now")
        return None
    count = _counted(len(inverted), "is", "are")
    report.note(f"meshwright improve: {output}: {count} still inverted")
    return STILL_INVERTED


def search_time(wanted: float | None, loading: float) -> float | None:
    """Seconds of a search of so many `wanted` ones, so that the whole command takes little longer:
    `loading` is what it took until then. None where there is no limit.
    """
    if wanted is None:
        return None
    return round(max(wanted - max(loading - LOADING, 0.0), LEAST * wanted), 2)


def _wishes(arguments: argparse.Namespace, start: HalfEdgeMesh) -> Wishes:
    """What is asked of the answer; UserError for what triangles do not have."""
    from meshwright_agent.search.improvement import Wishes

    for option, asked in (
        ("--blocks", arguments.blocks),
        ("--elements-shape", arguments.elements_shape is not None),
    ):
        if asked and start.kind == "tri":
            raise UserError(f"{option}: only quad meshes have blocks, and this one is of triangles")
    if arguments.elements_shape is not None and not 0.0 < arguments.elements_shape < 1.0:
        raise UserError("--elements-shape: a shape that can be reached lies between 0 and 1")
    blocks = arguments.blocks or arguments.elements_shape is not None
    return Wishes(
        arguments.prefer,
        arguments.min_shape,
        arguments.elements_shape,
        keep_size=mesh_input.is_mesh(arguments.input) and not blocks,
        in_place=arguments.film is not None,
    )


def _rows(mesh: HalfEdgeMesh, ids: np.ndarray) -> list[int]:
    """Places in a written file, counted from 0, of elements by id."""
    places = {int(e): row for row, e in enumerate(mesh.element_ids())}
    return [places[int(e)] for e in ids]


def _counted(count: int, one: str, many: str) -> str:
    return f"1 element {one}" if count == 1 else f"{count:,} elements {many}"


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
    arguments: argparse.Namespace,
    report: Report,
    mesh: HalfEdgeMesh,
    policy: Any,
    wishes: Wishes,
    seconds: float | None,
) -> Improved:
    from meshwright_agent.search import improvement

    rollouts = None if arguments.search else arguments.rollouts or ROLLOUTS
    with report.progress("searching", rollouts) as update:
        return improvement.improve(
            mesh,
            policy,
            wishes,
            rollouts=rollouts,
            seconds=seconds,
            max_steps=arguments.steps,
            seed=arguments.seed,
            progress=lambda done, best: update(done, f"s = {best}, s* = {mesh.optimum}"),
        )


def _text(values: dict[str, Any]) -> str:
    s = f"{values['score_before']} -> {values['score_after']}, s* = {values['optimum']}"
    if values["at_optimum"]:
        s += ", at the optimum"
    elements = mesh_output.counted(values["elements"], values["kind"])
    inverted = mesh_output.inverted_words(values["inverted_ids"]) or "none"
    if values["inverted_before"]:
        inverted += f" (before: {values['inverted_before']:,})"
    operations = f"{values['operations']} (best of {values['rollouts']})"
    if values["size_kept"] and values["method"] == "blocks":
        operations = f"new blocks, divided (best of {values['rollouts']})"
    rows = [
        ("s", s),
        ("elements", f"{values['elements_before']:,} -> {elements}"),
        *mesh_output.measure_rows(values),
        ("inverted", inverted),
        ("operations", operations),
        ("end", values["reason"]),
        ("seconds", f"{values['seconds']:.1f}"),
    ]
    files = (values["output"], values["png"], values["film"])
    written = ", ".join(file for file in files if file)
    return f"{values['input']} -> {written}\n" + table(rows)
