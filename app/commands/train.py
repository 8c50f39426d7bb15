"""``meshwright train``: train a policy."""

from __future__ import annotations

import argparse
from typing import Any

from app import inputs
from app.outputs import checked_folder
from app.report import Report, UserError, table

SUMMARY = "train a policy on random polygons"
DESCRIPTION = (
    "Train a policy by self-play on random polygons of the benchmark (PPO). The folder gets the "
    "policy (policy.safetensors), its configuration, its learning curve, and a checkpoint: the "
    "same command goes on where it was stopped."
)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Describe the kind, the configuration and the folder."""
    parser.add_argument("--kind", choices=("tri", "quad"), required=True, help="triangles or quads")
    parser.add_argument(
        "-o", "--output", metavar="FOLDER", required=True, help="folder to write to, or to go on in"
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
        "--seed", metavar="N", type=inputs.seed, help="in place of the seed of the configuration"
    )


def run(arguments: argparse.Namespace, report: Report) -> None:
    """Train, then say how good the policy has become."""
    folder = checked_folder(arguments.output)
    configuration = inputs.read_configuration(arguments.config, arguments.kind)
    from agent import training

    with report.progress("training", configuration.iterations) as update:
        try:
            found = training.train(
                arguments.config or training.shipped_configuration(arguments.kind),
                folder,
                minutes=arguments.minutes,
                seed=arguments.seed,
                report=lambda done, _, numbers: update(done, _remark(numbers)),
            )
        except training.ConfigurationError as error:
            raise UserError(str(error)) from error
    values = {"command": "train", "kind": arguments.kind, "folder": str(folder), **found}
    report.result(values, _text(values))


def _remark(numbers: dict[str, float]) -> str:
    return f"return {numbers['mean']:.3f}" if "mean" in numbers else ""


def _text(values: dict[str, Any]) -> str:
    rows = [
        ("updates", values["iteration"]),
        ("decisions", f"{values['decisions']:,}"),
        ("single rollout", f"{values['single_mean']:.3f} (normalised return, unseen polygons)"),
        ("best of 10", f"{values['best_mean']:.3f}"),
        ("at the optimum", f"{values['at_optimum']:.0%}"),
        ("seconds", f"{values['seconds']:.0f}"),
    ]
    return f"{values['policy']}\n" + table(rows)
