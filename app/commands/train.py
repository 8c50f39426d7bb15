"""``meshwright train``: train a policy."""

from __future__ import annotations

import argparse

from app import inputs
from app.report import Report

SUMMARY = "train a policy on random polygons"
DESCRIPTION = (
    "Train a policy by PPO on random polygons of the benchmark. The folder gets the policy "
    "(safetensors), its configuration and its learning curve."
)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Describe the kind, the configuration and the folder."""
    parser.add_argument("--kind", choices=("tri", "quad"), required=True, help="triangles or quads")
    parser.add_argument(
        "--config",
        metavar="FILE",
        help="training configuration (the one that the shipped policy was trained with)",
    )
    parser.add_argument(
        "-o", "--output", metavar="FOLDER", help="folder to write to (runs/KIND beside you)"
    )
    parser.add_argument(
        "--minutes", metavar="M", type=inputs.positive_float, help="stop after so many minutes"
    )
    parser.add_argument("--seed", metavar="N", type=inputs.seed, help="seed of all that is random")


def run(arguments: argparse.Namespace, report: Report) -> None:
    """Train, then say where everything is."""
    raise NotImplementedError
