"""Every level: its mesh, its par, whether fewer operations would do, and how many the agent takes.

The proof looks at all ways of fewer operations than par, as far as the time allows; a level whose
file states that its par is proved, but where the search finds a shorter way, is an error. The agent
is the solver, which shortens what it finds, without fewer elements in mind.
"""

from __future__ import annotations

import time
from typing import Any

from meshwright.console import Update
from meshwright.document.document import Document
from meshwright.puzzles import level as levels
from meshwright.puzzles.level import Level
from meshwright_agent.policy import policy_files
from meshwright_agent.search import solver
from meshwright_agent.search.exhaustive import FewestResult, fewest
from meshwright_core import MeshError
from meshwright_core.geometry import quality

SUMMARY = "every level: par, proof that no fewer operations will do, the agent's operations"
SECONDS = 2.0
"""Time limit of the agent for each level, in seconds."""

NODES = 300_000
"""Limit on the states that the proof visits."""
QUICK, QUICK_NODES, QUICK_SECONDS = 4, 3_000, 0.3


def run(seed: int, quick: bool, update: Update, seconds: float = SECONDS) -> dict[str, Any]:
    """Check all levels; quick: the first few, with a short proof search."""
    found = {}
    for number, level in enumerate(levels.all()[:QUICK] if quick else levels.all()):
        update(number, level.name)
        nodes = QUICK_NODES if quick else NODES
        found[level.name] = checked(level, nodes, QUICK_SECONDS if quick else seconds, seed)
    return found


def checked(level: Level, nodes: int, seconds: float, seed: int) -> dict[str, Any]:
    """One row; MeshError if the level does not match its file."""
    began = time.perf_counter()
    mesh = level.mesh()
    mesh.validate()
    reached = played(level)
    answer = fewest(mesh, level.goal, level.most, deepest=max(level.par - 1, 1), nodes=nodes)
    if answer.sequences and len(answer.sequences[0]) < level.par:
        raise MeshError(
            f"{level.name}: {len(answer.sequences[0])} operations will do, and its par is"
            f" {level.par}."
        )
    row = {
        "kind": level.kind,
        "elements": mesh.n_elements,
        "s": mesh.score,
        "s*": mesh.optimum,
        "par": level.par,
        "proved": level.proved,
        "proved_here": _shown_to_be_fewest(answer, level),
        "states": answer.nodes,
        "inverted": reached,
    }
    if not level.most:
        policy = policy_files.load(policy_files.shipped(level.kind)[0])
        solution = solver.solve(mesh, policy, seconds=seconds, seed=seed, coarsen=False)
        row |= {"agent": len(solution.operations), "agent_s": solution.score}
    return {**row, "seconds": round(time.perf_counter() - began, 2)}


def played(level: Level) -> int:
    """Inverted elements at the end of the solution, with smoothing after each operation."""
    document = Document(level.mesh(), level.title)
    for operation, (a, b) in level.solution:
        document.submit(operation, levels.halfedge_of(document.mesh or level.mesh(), a, b))
    if document.mesh is None or not level.reached(document.mesh):
        raise MeshError(f"{level.name}: its solution does not reach the goal.")
    return len(quality.inverted(document.mesh))


def _shown_to_be_fewest(answer: FewestResult, level: Level) -> bool:
    return level.par <= 1 or answer.proved >= level.par - 1


def text(results: dict[str, Any]) -> str:
    """A table, one line for each level."""
    head = ("level", "elements", "s", "s*", "par", "proved", "agent")
    rows = [head]
    for name, row in results.items():
        kind = "triangles" if row["kind"] == "tri" else "quads"
        proved = "yes" if row["proved_here"] else ("by its maker" if row["proved"] else "no")
        agent = "\u2013" if "agent" not in row else str(row["agent"])
        if row.get("agent_s", row["s*"]) != row["s*"]:
            agent += f" to s {row['agent_s']}"
        numbers = (f"{row['elements']} {kind}", str(row["s"]), str(row["s*"]), str(row["par"]))
        rows.append((name, *numbers, proved, agent))
    widths = [max(len(row[column]) for row in rows) for column in range(len(head))]
    lines = [
        "  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True))
        for row in rows
    ]
    return "\n".join(line.rstrip() for line in lines)
