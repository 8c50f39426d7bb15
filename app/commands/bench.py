"""``meshwright bench``: measure the program itself."""

from __future__ import annotations

import argparse

from app.report import Report

SUMMARY = "measure the program itself on this machine"
DESCRIPTION = "Run a suite of measurements and report the numbers."


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Describe the suite."""


def run(arguments: argparse.Namespace, report: Report) -> None:
    """Run."""
    raise NotImplementedError
