"""``meshwright bench``: run benchmarks."""

from __future__ import annotations

import argparse
import inspect
import os
import platform
import sys
import time
from collections.abc import Iterator, Mapping
from typing import Any

from meshwright.cli import arguments as inputs
from meshwright.console import Report, UserError, table

SUMMARY = "run benchmarks on this machine"
DESCRIPTION = "Run a suite of benchmarks and report the numbers."


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments."""
    parser.add_argument(
        "--suite", metavar="SUITE", help="suite to run; without it, list the suites"
    )
    parser.add_argument("--seed", metavar="N", type=inputs.seed, default=0, help="random seed (0)")
    parser.add_argument(
        "--quick", action="store_true", help="do a small part of the work, as a check that it runs"
    )
    parser.add_argument(
        "--seconds",
        metavar="S",
        type=inputs.positive_float,
        help="search time for each mesh, in suites that search",
    )
    parser.add_argument(
        "--meshes",
        metavar="M",
        type=inputs.positive_int,
        help="meshes in each row, in suites that draw them",
    )
    parser.add_argument(
        "--prefer",
        choices=("blocks", "balanced", "shape"),
        help="as for improve, in suites that search for blocks",
    )
    parser.add_argument(
        "--elements-shape",
        metavar="X",
        type=inputs.share,
        help="as for improve, in suites that search for blocks",
    )


def run(arguments: argparse.Namespace, report: Report) -> None:
    """Run the suite, or list the suites."""
    from meshwright import benchmarks

    names = benchmarks.names()
    if arguments.suite is None:
        summaries = {name: benchmarks.load(name).SUMMARY for name in names}
        text = table(list(summaries.items()), indent="")
        report.result({"command": "bench", "suites": summaries}, text)
        return
    suite = benchmarks.load(inputs.one_of(arguments.suite, names, "--suite"))
    options: dict[str, Any] = {}
    if arguments.seconds is not None:
        if not isinstance(getattr(suite, "SECONDS", None), float):
            raise UserError(f"--seconds: the suite {arguments.suite} has no search time")
        options["seconds"] = arguments.seconds
    if arguments.meshes is not None:
        if "meshes" not in inspect.signature(suite.run).parameters:
            raise UserError(f"--meshes: the suite {arguments.suite} has fixed meshes")
        options["meshes"] = arguments.meshes
    for option in ("prefer", "elements_shape"):
        if getattr(arguments, option) is not None:
            if option not in inspect.signature(suite.run).parameters:
                name = option.replace("_", "-")
                raise UserError(f"--{name}: the suite {arguments.suite} does not search for blocks")
            options[option] = getattr(arguments, option)
    start = time.perf_counter()
    with report.progress(arguments.suite) as update:
        results = suite.run(arguments.seed, arguments.quick, update, **options)
    values = {
        "command": "bench",
        "suite": arguments.suite,
        "quick": arguments.quick,
        "seed": arguments.seed,
        "machine": machine(),
        "results": results,
        "seconds": round(time.perf_counter() - start, 3),
    }
    head = f"{arguments.suite}: {suite.SUMMARY}\n{', '.join(machine().values())}\n"
    own = getattr(suite, "text", None)
    rows = [(name, _shown(value)) for name, value in flat(results)]
    report.result(values, head + (own(results) if own else table(rows)))


def machine() -> dict[str, str]:
    """Return the machine's properties that the numbers depend on."""
    import numba

    return {
        "system": f"{platform.system()} {platform.machine()}",
        "cores": f"{os.cpu_count()} cores",
        "python": f"Python {sys.version.split()[0]}",
        "numba": f"numba {numba.__version__}",
    }


def flat(values: Mapping[str, Any], before: str = "") -> Iterator[tuple[str, Any]]:
    """Yield the numbers of nested results with their joined names."""
    for name, value in values.items():
        if isinstance(value, Mapping):
            yield from flat(value, f"{before}{name}: ")
        else:
            yield before + name, value


def _shown(value: Any) -> str:
    if isinstance(value, float):
        return f"{value:,.0f}" if abs(value) >= 1000 else f"{value:.4g}"
    return f"{value:,}" if isinstance(value, int) and not isinstance(value, bool) else str(value)
