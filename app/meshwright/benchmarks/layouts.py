"""Shape at s*: random straight-sided parts as quads, one core, so many seconds each.

Part i of a row depends on the seed and on i alone. Each is meshed as ``meshwright mesh`` does by
default and improved; what is measured is the mesh at the positions of the answer.
"""

from __future__ import annotations

import time
from statistics import median
from typing import Any

import torch

from meshwright.benchmarks.parts import aligned, shown
from meshwright.console import Update
from meshwright_agent.policy import policy_files
from meshwright_agent.policy.policy_files import Policy
from meshwright_agent.search import solver
from meshwright_core.domains import meshing
from meshwright_core.domains.domain import Domain
from meshwright_core.domains.random_parts import parts
from meshwright_core.geometry import quality
from meshwright_core.geometry.element_shapes import element_shapes
from meshwright_core.geometry.shape_bound import shape_bound

SUMMARY = "random parts as quads: s, worst scaled Jacobian beside its bound q*, worst shape"
SECONDS = 10.0
"""Default search time for each part, in seconds."""
PARTS, QUICK = 40, 2
ROWS = ((8, 24), (25, 50))
"""Corners of the parts, over all loops."""
USABLE, GOOD = 0.3, 0.8
"""Worst scaled Jacobian of a usable mesh, and of a good one as a share of q*."""


def run(
    seed: int,
    quick: bool,
    update: Update,
    seconds: float = SECONDS,
    meshes: int = PARTS,
    prefer: str = "balanced",
) -> dict[str, Any]:
    """Improve `meshes` parts of each row; quick: two of each, a tenth of the time."""
    policy = policy_files.load(policy_files.shipped("quad")[0])
    torch.set_num_threads(1)
    solver.prepare(policy)
    found: dict[str, Any] = {}
    for low, high in ROWS:
        rows = {}
        for number, domain in enumerate(parts(QUICK if quick else meshes, (low, high), seed)):
            update(number, f"{low}-{high} corners: {number}")
            took = 0.1 * seconds if quick else seconds
            rows[f"{number} {domain.name}"] = solved(domain, policy, took, seed, prefer)
        found[f"{low}-{high} corners"] = {**summary(list(rows.values())), "shapes": rows}
    return found


def solved(
    domain: Domain, policy: Policy, seconds: float, seed: int, prefer: str
) -> dict[str, Any]:
    """One row of the table."""
    mesh = meshing.mesh_domain(domain, "quad")
    bound = shape_bound(mesh)
    began = time.perf_counter()
    solution = solver.solve(mesh, policy, seconds=seconds, seed=seed, prefer=prefer)
    took = time.perf_counter() - began
    solution.replay(mesh)
    solution.place(mesh)
    mesh.validate()
    return {
        "corners": sum(int(flags.sum()) for flags in domain.loop_corners),
        "holes": len(domain.holes),
        "s": mesh.score,
        "s*": mesh.optimum,
        "elements": mesh.n_elements,
        "worst SJ": round(float(quality.scaled_jacobian(mesh).min()), 3),
        "q*": round(bound, 3),
        "attainable": round(solution.attainable, 3),
        "worst shape": round(float(element_shapes(mesh).min()), 3),
        "inverted": len(quality.inverted(mesh)),
        "operations": len(solution.operations),
        "seconds": round(took, 2),
    }


def summary(rows: list[dict[str, Any]]) -> dict[str, Any]:
    """How many parts are at s*, usable and good, and medians."""
    return {
        "parts": len(rows),
        "at s*": sum(row["s"] == row["s*"] for row in rows),
        "inverted elements in": sum(row["inverted"] > 0 for row in rows),
        "at s* and usable": sum(
            row["s"] == row["s*"] and row["worst SJ"] >= USABLE for row in rows
        ),
        "at s* and good": sum(
            row["s"] == row["s*"] and row["worst SJ"] >= GOOD * row["q*"] for row in rows
        ),
        "every shape usable": sum(row["worst shape"] >= USABLE for row in rows),
        "share of q*, median": median(row["worst SJ"] / row["q*"] for row in rows),
        "elements, median": median(row["elements"] for row in rows),
    }


def text(results: dict[str, Any]) -> str:
    """The results as one table for each row, with its summary below."""
    tables = []
    for group, found in results.items():
        rows = [["part", *next(iter(found["shapes"].values()))]]
        rows += [[name, *map(shown, row.values())] for name, row in found["shapes"].items()]
        lines = [f"{name}: {value:.3g}" for name, value in found.items() if name != "shapes"]
        tables.append("\n".join([group, aligned(rows), *lines]))
    return "\n\n".join(tables)
