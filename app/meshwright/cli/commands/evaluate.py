"""``meshwright evaluate``: measure a policy on unseen random polygons."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from meshwright.cli import arguments as inputs
from meshwright.cli.output_files import checked_folder, checked_output
from meshwright.console import Report, Update, UserError
from meshwright.sources.naming import looks_like_path

if TYPE_CHECKING:
    from meshwright_agent.evaluation.table_row import RowResult
    from meshwright_agent.policy.policy_files import Policy

SUMMARY = "measure a policy on random polygons: the paper's tables and figures"
DESCRIPTION = (
    "Run a policy on random polygons of the benchmark and report the normalised return, "
    "(s_start - s_best) / (s_start - s*), of single rollouts and of the best of K: one row of the "
    "paper's tables, or all of them."
)
STRIPS = {"tri": (20,), "quad": (10, 20)}
"""Sides of the polygons whose rollouts are drawn, as in the paper's figures."""
BRIEF = 1.0
"""Default time, in seconds, of the race that a figure needs."""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments."""
    parser.add_argument("--kind", choices=("tri", "quad"), required=True, help="triangles or quads")
    rows = parser.add_mutually_exclusive_group()
    rows.add_argument(
        "--sides",
        metavar="A-B",
        type=inputs.sides,
        default=(10, 20),
        help="sides of the polygons (10-20)",
    )
    rows.add_argument("--table", action="store_true", help="all rows of the paper's table")
    parser.add_argument(
        "--meshes", metavar="M", type=inputs.positive_int, default=100, help="polygons a row (100)"
    )
    parser.add_argument(
        "--rollouts", metavar="K", type=inputs.positive_int, default=10, help="runs on each (10)"
    )
    parser.add_argument("--seed", metavar="N", type=inputs.seed, default=0, help="random seed (0)")
    parser.add_argument(
        "--policy",
        metavar="P",
        help="name of a shipped policy, a policy file, or a folder of a training (the shipped one)",
    )
    parser.add_argument(
        "--steps",
        metavar="FACTOR",
        type=inputs.positive_float,
        default=1.0,
        help="length of a run, relative to that in training (1)",
    )
    parser.add_argument(
        "--baselines",
        action="store_true",
        help="beside greedy descent, annealing and a random walk in the same time",
    )
    parser.add_argument(
        "--race",
        metavar="SECONDS",
        type=inputs.positive_float,
        help="share at s* against time: solver, annealing and greedy, so long on each mesh",
    )
    parser.add_argument(
        "--shorten",
        metavar="SECONDS",
        nargs="?",
        type=inputs.positive_float,
        const=1.0,
        help="shorten the solutions at s*, and coarsen those of quads, so long on each mesh (1)",
    )
    parser.add_argument(
        "--note",
        action="store_true",
        help="with --table and a policy file: write how it scores into the file",
    )
    parser.add_argument(
        "--figure",
        metavar="FOLDER",
        help="draw the learning curve, return against steps, share at s* against seconds "
        "(a race of 1 second, unless --race sets it), and rollouts",
    )


def run(arguments: argparse.Namespace, report: Report) -> None:
    """Measure and report the row, or the table; draw the figures."""
    folder = checked_folder(arguments.figure, "--figure") if arguments.figure else None
    noted = _checked_note(arguments) if arguments.note else None
    policy = inputs.read_policy(arguments.policy, arguments.kind)
    from meshwright.experiments import evaluation_table
    from meshwright_agent.evaluation import paper_results, rollouts, table_row

    table = [row.sides for row in paper_results.ROWS[arguments.kind]]
    wanted = table_row.RowSettings(
        arguments.meshes,
        arguments.rollouts,
        arguments.seed,
        arguments.baselines,
        arguments.race or (BRIEF if folder else None),
        arguments.shorten,
    )
    played = rollouts.longer(policy, arguments.steps)
    found = []
    for sides in table if arguments.table else [arguments.sides]:
        title = evaluation_table.sides(sides)
        with report.progress(title, arguments.meshes) as update:

            def show(what: str, done: int, update: Update = update) -> None:
                update(done, what)

            try:
                row = table_row.assess(played, sides, wanted, show)
            except rollouts.NothingToDo as error:
                raise UserError(f"{title}, {arguments.meshes} meshes: {error}") from error
        found.append(row)
    given = {
        "command": "evaluate",
        "kind": arguments.kind,
        "policy": policy.name,
        "meshes": arguments.meshes,
        "rollouts": arguments.rollouts,
        "seed": arguments.seed,
        "steps": arguments.steps,
    }
    if folder:
        given["figures"] = [str(path) for path in draw(policy, found, wanted, folder)]
    rows = [row.numbers for row in found]
    if noted is not None:
        note(policy, rows, noted)
        given["noted"] = str(noted)
    if arguments.table:
        text = evaluation_table.all_rows(arguments.kind, policy.name, given, rows)
        report.result({**given, "rows": rows}, _with_figures(text, given))
    else:
        text = evaluation_table.one_row(arguments.kind, policy.name, given, rows[0])
        report.result({**given, **rows[0]}, _with_figures(text, given))


def draw(policy: Policy, found: Sequence[RowResult], wanted: Any, folder: Path) -> list[Path]:
    """Draw all figures; returns their paths."""
    from meshwright.experiments import evaluation_table
    from meshwright_agent.evaluation import figures, paper_results, rollout_strip, rollouts
    from meshwright_core.core.kinds import KIND_NOUN

    folder.mkdir(exist_ok=True)
    kind, written = policy.kind, []

    def path(name: str) -> Path:
        written.append(folder / f"{kind}-{name}.png")
        return written[-1]

    training = policy.header.get("training")
    curve = (policy.header.get("progress") or {}).get("curve", [])
    if training and len(curve) > 1:
        noun = KIND_NOUN[kind].capitalize()
        low, high = training["sides"]
        title = f"{noun}, polygons of {low} to {high} sides"
        figures.learning_curve(curve, kind, title, path("learning"))
    titles = [evaluation_table.sides(row.sides) for row in found]
    returns = [
        (
            title,
            row.rolled,
            known.best.mean if (known := paper_results.row(kind, row.sides)) else None,
        )
        for title, row in zip(titles, found, strict=True)
    ]
    figures.returns_by_steps(returns, kind, path("returns"))
    races = [(title, row.times) for title, row in zip(titles, found, strict=True)]
    figures.shares_by_seconds(races, wanted.race, kind, path("seconds"))
    for sides in STRIPS[kind]:
        meshes = rollouts.unseen(kind, (sides, sides), 4, wanted.seed)[:1]
        rolled = rollouts.roll_out(policy, meshes, wanted.rollouts, wanted.seed)
        steps = rolled.steps(policy.task, meshes[0], 0, int(rolled.best()[0]))
        rollout_strip.rollout_strip(meshes[0], steps, path(f"rollout-{sides}"))
    return written


def note(policy: Policy, rows: Sequence[dict[str, Any]], path: Path) -> None:
    """Write the table into the header of the policy file, atomically."""
    from meshwright_agent.policy import policy_files
    from meshwright_core.errors import MeshError

    policy.header["table"] = list(rows)
    try:
        policy_files.save_policy(policy, path)
    except MeshError as error:
        raise UserError(str(error)) from error


def _checked_note(arguments: argparse.Namespace) -> Path:
    """The policy file to write the table into."""
    if not arguments.table or arguments.steps != 1.0:
        raise UserError("--note goes with --table, and not with --steps")
    if arguments.policy is None or not looks_like_path(arguments.policy):
        raise UserError("--note writes into a policy file: name it by --policy")
    return checked_output(arguments.policy, option="--policy")


def _with_figures(text: str, given: dict[str, Any]) -> str:
    return "\n".join([text, *([""] if given.get("figures") else []), *given.get("figures", [])])
