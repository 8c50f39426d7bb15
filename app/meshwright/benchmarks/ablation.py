"""What each part of the search for blocks brings: the same parts with one of them left out.

Random straight-sided parts as quads, one core, so many seconds each. Part i of a row depends on
the seed and on i alone.
"""

from __future__ import annotations

import time
from collections.abc import Iterator
from contextlib import contextmanager
from statistics import median
from typing import Any
from unittest.mock import patch

from meshwright.benchmarks.parts import GOOD, ROWS, USABLE, aligned, quad_policy, shown
from meshwright.console import Update
from meshwright_agent.policy.policy_files import Policy
from meshwright_agent.search import solution as positions
from meshwright_agent.search import solver
from meshwright_agent.search.layout_search import LayoutSearch
from meshwright_core.analysis.blocks import block_count
from meshwright_core.domains import meshing
from meshwright_core.domains.domain import Domain
from meshwright_core.domains.random_parts import parts
from meshwright_core.geometry import quality, smoothing
from meshwright_core.geometry.element_shapes import element_shapes
from meshwright_core.geometry.shape_bound import shape_bound

SUMMARY = "what each part of the search for blocks brings: parts with one of them left out"
SECONDS = 10.0
"""Default search time for each part, in seconds."""
PARTS, QUICK = 12, 1


def _no_kicks(self: LayoutSearch, stop: Any, kicks: int | None = None) -> None:
    """In place of the local search: nothing, until the time is up."""
    while kicks is None and not stop():
        time.sleep(0.01)


@contextmanager
def _as_it_is() -> Iterator[dict[str, Any]]:
    yield {}


@contextmanager
def _without_shape() -> Iterator[dict[str, Any]]:
    yield {"prefer": "blocks"}


@contextmanager
def _without_local_search() -> Iterator[dict[str, Any]]:
    with patch.object(LayoutSearch, "run", _no_kicks):
        yield {}


@contextmanager
def _without_coarsening() -> Iterator[dict[str, Any]]:
    yield {"coarsen": False}


@contextmanager
def _without_max_min() -> Iterator[dict[str, Any]]:
    with patch.object(positions, "_raise_worst", smoothing.relax):
        yield {}


VARIANTS = {
    "all": _as_it_is,
    "shape does not count (blocks)": _without_shape,
    "no local search among layouts": _without_local_search,
    "no coarsening (rollouts alone)": _without_coarsening,
    "smoothing, not max-min, at the end": _without_max_min,
}
"""Name of each row, and what is changed for it."""


def run(
    seed: int, quick: bool, update: Update, seconds: float = SECONDS, meshes: int = PARTS
) -> dict[str, Any]:
    """Improve `meshes` parts of each row in each variant; quick: one part, a tenth of the time."""
    policy = quad_policy()
    found: dict[str, Any] = {}
    done = 0
    for low, high in ROWS:
        domains = parts(QUICK if quick else meshes, (low, high), seed)
        group = found[f"{low}-{high} corners"] = {}
        for name, changed in VARIANTS.items():
            rows = []
            for domain in domains:
                update(done, f"{low}-{high} corners: {name}")
                with changed() as options:
                    took = 0.1 * seconds if quick else seconds
                    rows.append(_solved(domain, policy, took, seed, options))
                done += 1
            group[name] = _summary(rows)
    return found


def _solved(
    domain: Domain, policy: Policy, seconds: float, seed: int, options: dict[str, Any]
) -> dict[str, Any]:
    mesh = meshing.mesh_domain(domain, "quad")
    bound = shape_bound(mesh)
    answer = solver.solve(mesh, policy, seconds=seconds, seed=seed, **options)
    answer.carry_out(mesh)
    return {
        "at s*": mesh.score == mesh.optimum,
        "inverted": len(quality.inverted(mesh)),
        "worst SJ": float(quality.scaled_jacobian(mesh).min()),
        "worst shape": float(element_shapes(mesh).min()),
        "q*": bound,
        "blocks": block_count(mesh),
    }


def _summary(rows: list[dict[str, Any]]) -> dict[str, Any]:
    return {
        "parts": len(rows),
        "at s*": sum(row["at s*"] for row in rows),
        "not inverted": sum(not row["inverted"] for row in rows),
        f"SJ >= {USABLE}": sum(row["worst SJ"] >= USABLE for row in rows),
        f"SJ >= {GOOD} q*": sum(row["worst SJ"] >= GOOD * row["q*"] - 5e-4 for row in rows),
        "SJ / q*, median": round(median(row["worst SJ"] / max(row["q*"], 1e-9) for row in rows), 3),
        "worst shape, median": round(median(row["worst shape"] for row in rows), 3),
        "blocks, median": median(row["blocks"] for row in rows),
    }


def text(results: dict[str, Any]) -> str:
    """Return the results as one table for each row of parts."""
    tables = []
    for group, found in results.items():
        rows = [[group, *next(iter(found.values()))]]
        rows += [[name, *map(shown, row.values())] for name, row in found.items()]
        tables.append(aligned(rows))
    return "\n\n".join(tables)
