"""``meshwright train``: train a policy."""

from __future__ import annotations

import argparse
import os
from contextlib import nullcontext
from typing import Any

from meshwright.cli import arguments as inputs
from meshwright.cli.output_files import checked_folder
from meshwright.console import Report, UserError, table

SUMMARY = "train a policy on random polygons"
DESCRIPTION = (
    "Train a policy by self-play on random polygons of the benchmark (PPO). The folder gets the "
    "policy (policy.safetensors: the best by evaluation), its configuration, its learning curve, "
    "events for TensorBoard, and a checkpoint: the same command resumes a stopped training. "
    "On N processes, each with its share of the runs: "
    "torchrun --nproc-per-node N -m meshwright train ..."
)
NO_EVENTS = (
    "no events for TensorBoard are written: they need tensorboardX "
    '(pip install "meshwright[train]")'
)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments."""
    parser.add_argument("--kind", choices=("tri", "quad"), required=True, help="triangles or quads")
    parser.add_argument(
        "-o",
        "--output",
        metavar="FOLDER",
        required=True,
        help="folder to write to, or to resume in; made where it does not exist",
    )
    parser.add_argument(
        "--config",
        metavar="FILE.toml",
        help="training configuration (that of the shipped policy)",
    )
    parser.add_argument(
        "--minutes", metavar="M", type=inputs.positive_float, help="stop after so many minutes"
    )
    parser.add_argument(
        "--seed", metavar="N", type=inputs.seed, help="replaces the seed of the configuration"
    )
    parser.add_argument(
        "--no-table",
        action="store_true",
        help="leave out the rows of the paper's table at the end, which take minutes",
    )


def run(arguments: argparse.Namespace, report: Report) -> None:
    """Train, then report the evaluation of the policy."""
    folder = checked_folder(arguments.output, parents=True)
    configuration = inputs.read_configuration(arguments.config, arguments.kind)
    from meshwright.cli.training_progress import shown
    from meshwright_agent.training import tensorboard, trainer

    # of the processes that torchrun starts, only the first one reports
    speaks = os.environ.get("RANK", "0") == "0"
    if speaks and not tensorboard.available():
        report.note(NO_EVENTS)
    total, minutes = configuration.iterations, arguments.minutes
    with shown(report.err, total, minutes) if speaks else nullcontext() as display:
        try:
            found = trainer.train(
                arguments.config or trainer.shipped_configuration(arguments.kind),
                folder,
                minutes=minutes,
                seed=arguments.seed,
                report=display.update if display else None,
                finishing=display.finish if display else None,
                table=not arguments.no_table,
            )
        except trainer.ConfigurationError as error:
            raise UserError(str(error)) from error
    if found:
        values = {"command": "train", "kind": arguments.kind, "folder": str(folder), **found}
        report.result(values, _text(values))


def _text(values: dict[str, Any]) -> str:
    rows = [
        ("updates", values["iteration"]),
        ("best after", f"{values['best_iteration']} updates: that policy is the result"),
        ("decisions", f"{values['decisions']:,}"),
        ("single rollout", f"{values['single_mean']:.3f} (normalised return, unseen polygons)"),
        ("best of 10", f"{values['best_mean']:.3f}"),
        ("at the optimum", f"{values['at_optimum']:.0%}"),
        ("seconds", f"{values['seconds']:.0f}"),
    ]
    return f"{values['policy']}\n" + table(rows)
