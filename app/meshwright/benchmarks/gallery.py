"""``meshwright mesh`` and ``meshwright improve`` on every shape of the gallery, file to file."""

from __future__ import annotations

import tempfile
import time
from pathlib import Path
from typing import Any

import numpy as np

from meshwright.console import Update
from meshwright.document.position_repair import settle
from meshwright_agent.policy import policy_files
from meshwright_agent.policy.policy_files import Policy
from meshwright_agent.search import solver
from meshwright_core import HalfEdgeMesh, read, write
from meshwright_core.domains import gallery, meshing
from meshwright_core.geometry import quality

SUMMARY = "every shape of the gallery, meshed and improved file to file: s, corners, folds"

QUICK = ("star", "annulus")
ROLLOUTS = 10
"""Of each shape, as many as ``meshwright improve`` does by default."""


def run(seed: int, quick: bool, update: Update) -> dict[str, Any]:
    """Improve each shape as triangles and as quads with ten rollouts (quick: two shapes, one)."""
    names = QUICK if quick else gallery.names()
    found: dict[str, Any] = {}
    for kind in ("tri", "quad"):
        policy = policy_files.load(policy_files.shipped(kind)[0])
        rows = {}
        for number, name in enumerate(names):
            update(number, f"{kind} {name}")
            rows[name] = improved(name, kind, policy, 1 if quick else ROLLOUTS, seed)
        found[kind] = {
            "shapes": len(rows),
            "at the optimum": sum(row["at_optimum"] for row in rows.values()),
            "without inverted elements": sum(not row["inverted"] for row in rows.values()),
            "corners and s* kept": sum(row["kept"] for row in rows.values()),
            **rows,
        }
    return found


def improved(name: str, kind: str, policy: Policy, rollouts: int, seed: int) -> dict[str, Any]:
    """Return one row; a file that is not a valid mesh ends it as an error."""
    began = time.perf_counter()
    with tempfile.TemporaryDirectory() as folder:
        first, last = Path(folder) / "in.vtk", Path(folder) / "out.vtk"
        made = meshing.mesh_domain(gallery.shape(name), kind)
        settle(made)
        write(first, made)
        mesh = read(first)
        before = mesh.copy()
        solution = solver.solve(mesh, policy, rollouts=rollouts, seed=seed)
        solution.replay(mesh)
        settle(mesh)
        write(last, mesh)
        after = read(last)
        after.validate()
    return {
        "s": before.score,
        "s after": after.score,
        "s*": after.optimum,
        "at_optimum": after.score == after.optimum,
        "elements": before.n_elements,
        "elements after": after.n_elements,
        "inverted": quality.inverted(after).tolist(),
        "kept": corners(before) == corners(made) == corners(after)
        and made.optimum == before.optimum == after.optimum,
        "operations": len(solution.operations),
        "seconds": round(time.perf_counter() - began, 2),
    }


def corners(mesh: HalfEdgeMesh) -> set[tuple[float, ...]]:
    """Return where the geometric vertices are."""
    ids = mesh.vertices()
    places = mesh.points[ids[mesh.geometric()[ids]]]
    return {tuple(place) for place in np.round(places, 12).tolist()}
