"""``meshwright demo``: the star with the agent ready; without a display, the same as a picture."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

from meshwright.cli import arguments as inputs
from meshwright.cli import display_check
from meshwright.cli.output_files import checked_output
from meshwright.console import Report, UserError

if TYPE_CHECKING:
    from meshwright_core import HalfEdgeMesh

SUMMARY = "open a shape with the agent ready; without a display, write a picture of its run"
DESCRIPTION = (
    "Open the window on a shape with the agent ready. On a machine without a display, or with -o, "
    "let the policy complete the mesh and write a picture: start, half-way, end."
)

PICTURE = "meshwright-demo.png"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments."""
    parser.add_argument("--shape", metavar="SHAPE", default="star", help="shape or file (star)")
    parser.add_argument(
        "--kind", choices=("tri", "quad"), default="quad", help="triangles or quads (quad)"
    )
    parser.add_argument(
        "-o",
        "--output",
        metavar="PICTURE.png",
        help=f"write a picture in place of opening the window ({PICTURE} without a display)",
    )


def run(arguments: argparse.Namespace, report: Report) -> None:
    """Open the window, or write the picture."""
    output = _checked(arguments.output) if arguments.output else None
    probe = None if output else display_check.DisplayProbe()
    domain = inputs.read_domain(arguments.shape)
    mesh = inputs.make_mesh(domain, arguments.kind)
    name = domain.name or Path(arguments.shape).stem
    problem = probe.problem() if probe else ""
    if output or problem:
        _picture(mesh, name, output or _checked(PICTURE), problem, report)
        return
    from meshwright import desktop
    from meshwright.document.document import Document

    code = desktop.run(Document(mesh, name=name), demo=True)
    if code != 0:
        raise RuntimeError(f"the window ended with code {code}")
    if report.as_json:
        report.result({"command": "demo", "shape": name, "window": True}, "")


def _checked(path: str) -> Path:
    return checked_output(path, (".png",))


def _picture(mesh: HalfEdgeMesh, name: str, output: Path, problem: str, report: Report) -> None:
    from meshwright.cli.commands.improve import ROLLOUTS
    from meshwright.console import one_line
    from meshwright.graphics.export import filmstrip
    from meshwright_core.core.kinds import KIND_NOUN
    from meshwright_core.core.score import normalised_return

    policy = inputs.read_policy(None, mesh.kind)
    from meshwright_agent.search import solver
    from meshwright_core.errors import MeshError, sentence

    inputs.prepare_agent(report)
    with report.progress("the policy is at work", ROLLOUTS) as update:
        solution = solver.solve(
            mesh,
            policy,
            rollouts=ROLLOUTS,
            progress=lambda done, best: update(done, f"s = {best}, s* = {mesh.optimum}"),
        )
    start = mesh.score
    try:
        filmstrip.write(output, mesh, solution.operations)
    except MeshError as error:
        raise UserError(str(error)) from error
    values = {
        "command": "demo",
        "shape": name,
        "window": False,
        "picture": str(output.resolve()),
        "reason": problem or "a picture was requested",
        "policy": policy.name,
        "kind": mesh.kind,
        "elements_before": mesh.n_elements,
        "score_before": start,
        "score_after": solution.score,
        "optimum": mesh.optimum,
        "normalised_return": normalised_return(start, solution.score, mesh.optimum),
        "operations": len(solution.operations),
    }
    optimum = (
        ", the optimum" if solution.score == mesh.optimum else f" (the optimum is {mesh.optimum})"
    )
    text = (
        f"the policy took the {name}, {mesh.n_elements} {KIND_NOUN[mesh.kind]}, from "
        f"s = {start} to s = {solution.score}{optimum}, in {len(solution.operations)} operations; "
        f"the picture of it is {output.resolve()}"
    )
    if problem:
        text = f"{problem}, so in place of the window: {text}"
    report.result(values, sentence(one_line(text)))
