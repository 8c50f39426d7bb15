"""``meshwright evaluate``: measure a policy on unseen random polygons."""

from __future__ import annotations

import argparse
from typing import Any

from app import inputs
from app.report import Report

SUMMARY = "measure a policy on random polygons: one row of the paper's tables"
DESCRIPTION = (
    "Run a policy on random polygons of the benchmark and report the normalised return, "
    "(s_start - s_best) / (s_start - s*), of single rollouts and of the best of K."
)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Describe the row: kind, sides, how many meshes and rollouts."""
    parser.add_argument("--kind", choices=("tri", "quad"), required=True, help="triangles or quads")
    parser.add_argument(
        "--sides",
        metavar="A-B",
        type=inputs.sides,
        default=(10, 20),
        help="sides of the polygons (10-20)",
    )
    parser.add_argument(
        "--meshes", metavar="M", type=inputs.positive_int, default=100, help="polygons (100)"
    )
    parser.add_argument(
        "--rollouts", metavar="K", type=inputs.positive_int, default=10, help="runs on each (10)"
    )
    parser.add_argument(
        "--seed", metavar="N", type=inputs.seed, default=0, help="seed of all that is random (0)"
    )
    parser.add_argument(
        "--policy", metavar="P", help="name of a shipped policy, or a policy file (the shipped one)"
    )


def run(arguments: argparse.Namespace, report: Report) -> None:
    """Measure and report the row."""
    policy = inputs.read_policy(arguments.policy, arguments.kind)
    from agent import evaluate

    with report.progress("evaluating", arguments.meshes) as update:
        row = evaluate.evaluate(
            arguments.kind,
            sides=arguments.sides,
            meshes=arguments.meshes,
            rollouts=arguments.rollouts,
            seed=arguments.seed,
            policy=policy,
            progress=lambda done: update(done, ""),
        )
    given = {
        "command": "evaluate",
        "kind": arguments.kind,
        "policy": policy.name,
        "sides": list(arguments.sides),
        "meshes": arguments.meshes,
        "rollouts": arguments.rollouts,
        "seed": arguments.seed,
    }
    report.result({**given, **row}, _text({**given, **row}))


def _text(row: dict[str, Any]) -> str:
    low, high = row["sides"]
    return (
        f"{inputs.KIND_NOUN[row['kind']]}, {low}-{high} sides, {row['meshes']} meshes, "
        f"{row['policy']}: single {row['single_mean']:.3f} (std {row['single_std']:.3f}), "
        f"best of {row['rollouts']} {row['best_mean']:.3f} (std {row['best_std']:.3f}), "
        f"at the optimum {row['at_optimum']:.0%}, {row['operations_median']:.0f} operations "
        f"(median), {row['seconds']:.1f} s"
    )
