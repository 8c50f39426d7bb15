"""The solver on 24 random parts with curved sides and ten airfoils in boxes, as quads, one core.

Each is meshed as ``meshwright mesh`` does by default, improved for so many seconds, smoothed and
untangled. The columns *15 degrees* are what a mesh of the same part starts with whose curves have
been replaced by polylines that turn by 15 degrees at each point. Each part depends on the seed and
on its number alone.
"""

from __future__ import annotations

import time
from statistics import median
from typing import Any

import numpy as np

from meshwright.benchmarks.parts import aligned, improve, shown
from meshwright.console import Update
from meshwright_agent.policy import policy_files
from meshwright_agent.policy.policy_files import Policy
from meshwright_core import HalfEdgeMesh
from meshwright_core.domains import meshing
from meshwright_core.domains.curved_parts import curved_suite
from meshwright_core.domains.domain import Domain
from meshwright_core.geometry import quality
from meshwright_core.geometry.edge_curves import element_areas

SUMMARY = (
    "parts with curved sides and airfoils as quads: start, s, s*, shapes after so many seconds"
)
SECONDS = 10.0
"""Default search time for each part, in seconds."""

FLAT_STEP = 15.0
QUICK = 2


def run(seed: int, quick: bool, update: Update, seconds: float = SECONDS) -> dict[str, Any]:
    """Improve the suite; quick: two parts, a tenth of the time."""
    policy = policy_files.load(policy_files.shipped("quad")[0])
    time_each = 0.1 * seconds if quick else seconds
    domains = curved_suite(seed)
    rows = {}
    for number, domain in enumerate(domains[:QUICK] if quick else domains):
        update(number, domain.name)
        rows[domain.name] = solved(domain, policy, time_each, seed)
    return {**summary(list(rows.values())), "shapes": rows}


def solved(domain: Domain, policy: Policy, seconds: float, seed: int) -> dict[str, Any]:
    """Return one row of the table."""
    began = time.perf_counter()
    mesh = meshing.mesh_domain(domain, "quad")
    meshed = time.perf_counter() - began
    before = mesh.copy()
    flat = meshing.mesh_domain(domain.flattened(FLAT_STEP), "quad")
    solution, took = improve(mesh, policy, seconds, seed)
    return {
        "corners": sum(int(flags.sum()) for flags in domain.loop_corners),
        "holes": len(domain.holes),
        "15 degrees: quads": flat.n_elements,
        "15 degrees: s": flat.score,
        "quads start": before.n_elements,
        "s start": before.score,
        "inverted start": len(quality.inverted(before)),
        "s*": mesh.optimum,
        "s": mesh.score,
        "quads": mesh.n_elements,
        "inverted": len(quality.inverted(mesh)),
        "worst Jacobian": round(float(quality.scaled_jacobian(mesh).min()), 3),
        "area error": float(f"{abs(element_areas(mesh).sum() / domain.area - 1.0):.1e}"),
        "off the curves": float(f"{off_curves(mesh):.1e}"),
        "operations": len(solution.operations),
        "meshing": round(meshed, 2),
        "seconds": round(took, 2),
    }


def off_curves(mesh: HalfEdgeMesh) -> float:
    """The largest distance of a vertex from its place on its curve, in sizes of the mesh."""
    rows = mesh.vertices()
    rows = rows[mesh.curve_ids()[rows] >= 0]
    return float(mesh.off_curve()[rows].max() / np.ptp(mesh.points[rows], axis=0).max())


def summary(rows: list[dict[str, Any]]) -> dict[str, Any]:
    """How many are at the optimum and valid; what they start with."""
    return {
        "meshes": len(rows),
        "at s*": sum(row["s"] == row["s*"] for row in rows),
        "not inverted": sum(not row["inverted"] for row in rows),
        "at s* and not inverted": sum(
            row["s"] == row["s*"] and not row["inverted"] for row in rows
        ),
        "area within 1e-6": sum(row["area error"] <= 1e-6 for row in rows),
        "on the curves": sum(row["off the curves"] <= 1e-9 for row in rows),
        "start not inverted": sum(not row["inverted start"] for row in rows),
        "15 degrees: quads at the start, median": median(row["15 degrees: quads"] for row in rows),
        "15 degrees: s at the start, median": median(row["15 degrees: s"] for row in rows),
        "quads at the start, median": median(row["quads start"] for row in rows),
        "s at the start, median": median(row["s start"] for row in rows),
        "quads, median": median(row["quads"] for row in rows),
        "worst Jacobian, median": median(row["worst Jacobian"] for row in rows),
        "operations, median": median(row["operations"] for row in rows),
    }


def text(results: dict[str, Any]) -> str:
    """Return the results as a table with its summary below."""
    shapes = results["shapes"]
    rows = [["shape", *next(iter(shapes.values()))]]
    rows += [[name, *map(shown, row.values())] for name, row in shapes.items()]
    counts = [
        f"{name}: {value} of {results['meshes']}"
        for name, value in results.items()
        if isinstance(value, int) and name != "meshes" and "," not in name
    ]
    medians = [f"{name}: {value:.3g}" for name, value in results.items() if "," in name]
    return "\n".join([aligned(rows), *counts, *medians])
