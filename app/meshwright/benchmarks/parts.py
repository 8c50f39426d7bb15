"""The solver on the gallery and on random straight-sided parts, as quads, one core.

Each shape is meshed as ``meshwright mesh`` does by default and improved for so many seconds. *First
usable* is the seconds until the search had an answer at s*, without inverted elements and with a
worst scaled Jacobian of 0.3 or more; *last better* those until it had the best one. Beside random
parts stands Gmsh where its module is installed. Part i of a row depends on the seed and on i alone.
"""

from __future__ import annotations

import math
import time
from statistics import median
from typing import Any

from meshwright.benchmarks import gmsh_peer
from meshwright.benchmarks.gallery import corners
from meshwright.console import Update
from meshwright.document.position_repair import settle
from meshwright_agent.policy import policy_files
from meshwright_agent.policy.policy_files import Policy
from meshwright_agent.search import improvement, solver
from meshwright_agent.search.improvement import Wishes
from meshwright_agent.search.solution import Solution
from meshwright_core import HalfEdgeMesh
from meshwright_core.analysis.blocks import block_count
from meshwright_core.domains import gallery, meshing
from meshwright_core.domains.domain import Domain
from meshwright_core.domains.random_parts import parts
from meshwright_core.geometry import quality
from meshwright_core.geometry.edge_curves import element_areas
from meshwright_core.geometry.element_shapes import element_shapes
from meshwright_core.geometry.shape_bound import shape_bound

SUMMARY = "gallery and random parts as quads: s, s*, blocks, shapes and q* after so many seconds"
SECONDS = 10.0
"""Default search time for each shape, in seconds."""

PARTS = 40
ROWS = ((8, 24), (25, 50))
"""Corners of the parts, over all loops."""
QUICK = 2
USABLE, GOOD = 0.3, 0.8
"""Worst scaled Jacobian, or shape, of a usable mesh; and of a good one as a share of q*."""
WISHES = Wishes()


def quad_policy() -> Policy:
    """The shipped policy for quads, ready to be measured on one core."""
    policy = policy_files.load(policy_files.shipped("quad")[0])
    policy_files.decide_on_one_thread()
    solver.prepare(policy)
    return policy


def run(
    seed: int,
    quick: bool,
    update: Update,
    seconds: float = SECONDS,
    meshes: int = PARTS,
    prefer: str = "balanced",
    elements_shape: float | None = None,
) -> dict[str, Any]:
    """Improve the gallery and so many parts of each row; quick: two of each, a tenth of the time.

    Where the module `gmsh` can be imported its meshes of about as many quads stand beside parts.
    """
    policy = quad_policy()
    time_each = 0.1 * seconds if quick else seconds
    wishes = Wishes(prefer, elements_shape=elements_shape)
    groups = {"gallery": list(gallery.gallery().values())}
    for low, high in ROWS:
        groups[f"{low}-{high} corners"] = parts(QUICK if quick else meshes, (low, high), seed)
    found: dict[str, Any] = {}
    for group, domains in groups.items():
        rows = {}
        for number, domain in enumerate(domains[:QUICK] if quick else domains):
            name = domain.name if group == "gallery" else f"{number} {domain.name}"
            update(number, f"{group}: {name}")
            rows[name] = solved(domain, policy, time_each, seed, wishes)
            if group != "gallery":  # which has curves
                rows[name] |= gmsh_peer.measured(domain, rows[name]["elements"])
        found[group] = {**summary(list(rows.values())), "shapes": rows}
    return found


def solved(
    domain: Domain, policy: Policy, seconds: float, seed: int, wishes: Wishes = WISHES
) -> dict[str, Any]:
    """Return one row of the table."""
    before = meshing.mesh_domain(domain, "quad")
    places, bound = corners(before), shape_bound(before)
    answers: list[tuple[float, int, float]] = []
    began = time.perf_counter()

    def found(best: Solution) -> None:
        answers.append((time.perf_counter() - began, best.score, best.worst_scaled_jacobian))

    answer = improvement.improve(before, policy, wishes, seconds=seconds, seed=seed, found=found)
    took = time.perf_counter() - began
    usable = [when for when, score, worst in answers if score == before.optimum and worst >= USABLE]
    mesh = answer.mesh
    mesh.validate()
    return {
        "corners": sum(int(flags.sum()) for flags in domain.loop_corners),
        "holes": len(domain.holes),
        "s start": before.score,
        "s": mesh.score,
        "s*": mesh.optimum,
        "elements start": before.n_elements,
        "elements": mesh.n_elements,
        "blocks": block_count(mesh),
        "outline": round(_area(mesh) / domain.area, 3),
        "worst SJ": round(float(quality.scaled_jacobian(mesh).min()), 3),
        "q*": round(bound, 3),
        "worst shape": round(float(element_shapes(mesh).min()), 3),
        "inverted": len(quality.inverted(mesh)),
        "kept": corners(mesh) == places and mesh.optimum == before.optimum,
        "operations": len(answer.operations),
        "first usable": round(usable[0], 2) if usable else None,
        "last better": round(answers[-1][0], 2) if answers else None,
        "seconds": round(took, 2),
    }


def improve(
    mesh: HalfEdgeMesh, policy: Policy, seconds: float, seed: int
) -> tuple[Solution, float]:
    """Search, replay what was found, smooth and untangle; also the seconds that the search took."""
    began = time.perf_counter()
    solution = solver.solve(mesh, policy, seconds=seconds, seed=seed)
    took = time.perf_counter() - began
    if not solution.carry_out(mesh):
        settle(mesh)
    mesh.validate()
    return solution, took


def _area(mesh: HalfEdgeMesh) -> float:
    """The area of a plane mesh between its true edges: that of its domain, if it fills it."""
    return float(element_areas(mesh).sum())


def summary(rows: list[dict[str, Any]]) -> dict[str, Any]:
    """How many rows are at the optimum, valid, usable and good, with every corner kept; medians."""
    found = {
        "meshes": len(rows),
        "at s*": sum(row["s"] == row["s*"] for row in rows),
        "not inverted": sum(not row["inverted"] for row in rows),
        "at s* and not inverted": sum(
            row["s"] == row["s*"] and not row["inverted"] for row in rows
        ),
        f"at s* and worst SJ of {USABLE} or more": sum(
            row["s"] == row["s*"] and row["worst SJ"] >= USABLE for row in rows
        ),
        f"worst SJ of {GOOD} q* or more": sum(
            row["worst SJ"] >= GOOD * row["q*"] - 5e-4 for row in rows
        ),
        f"at s* and every shape {USABLE} or more": sum(
            row["s"] == row["s*"] and row["worst shape"] >= USABLE for row in rows
        ),
        "corners kept": sum(row["kept"] for row in rows),
        "outline within 5 %": sum(abs(row["outline"] - 1.0) < 0.05 for row in rows),
        "elements relative to the start, mean": sum(
            row["elements"] / row["elements start"] for row in rows
        )
        / len(rows),
        "blocks, median": median(row["blocks"] for row in rows),
        "worst SJ, median": median(row["worst SJ"] for row in rows),
        "share of q*, median": median(row["worst SJ"] / max(row["q*"], 1e-9) for row in rows),
        "operations, median": median(row["operations"] for row in rows),
        "first usable, seconds, median": reached_by(0.5, rows, "first usable"),
        "first usable, seconds, 90 %": reached_by(0.9, rows, "first usable"),
        "last better, seconds, median": reached_by(0.5, rows, "last better"),
        "last better, seconds, 90 %": reached_by(0.9, rows, "last better"),
        "seconds, median": median(row["seconds"] for row in rows),
    }
    return found | gmsh_peer.summary(rows, USABLE)


def reached_by(share: float, rows: list[dict[str, Any]], column: str) -> float | None:
    """Seconds after which that share of all rows have what the column dates; None if fewer have."""
    seconds = sorted(row[column] for row in rows if row[column] is not None)
    wanted = max(1, math.ceil(share * len(rows) - 1e-9))
    return seconds[wanted - 1] if wanted <= len(seconds) else None


def text(results: dict[str, Any]) -> str:
    """Return the results as one table for each group, with its summary below."""
    tables = []
    for group, found in results.items():
        rows = [["shape", *next(iter(found["shapes"].values()))]]
        rows += [[name, *map(shown, row.values())] for name, row in found["shapes"].items()]
        lines = [
            f"{name}: {value} of {found['meshes']}"
            for name, value in found.items()
            if isinstance(value, int) and name != "meshes" and "," not in name
        ]
        lines += [
            f"{name}: {shown(value) if value is None else format(value, '.3g')}"
            for name, value in found.items()
            if "," in name
        ]
        tables.append("\n".join([group, aligned(rows), *lines]))
    return "\n\n".join(tables)


def shown(value: Any) -> str:
    """Return a cell of the table."""
    if value is None:
        return "never"
    return ("no", "yes")[value] if isinstance(value, bool) else f"{value}"


def aligned(rows: list[list[str]]) -> str:
    """Return rows of cells as lines of columns, the first one flush left."""
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    return "\n".join(
        "  ".join(
            cell.rjust(width) if column else cell.ljust(width)
            for column, (cell, width) in enumerate(zip(row, widths, strict=True))
        )
        for row in rows
    )
