"""Cold and warm starts of ``meshwright mesh`` and ``meshwright improve``, each in fresh processes.

Cold: with an empty folder of kernels; ``improve`` finds there what ``mesh`` has compiled, as after
a first look at the program. Seconds by the clock, and seconds of processor time of the command and
all its processes, which other programs on the machine disturb less.
"""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

from meshwright.console import Update

SUMMARY = "cold and warm start of mesh and improve, and what of it is imports"

ROUNDS = 3
"""Warm starts, of which the fastest counts."""

_IMPORTS = {
    "mesh": "from meshwright_core.domains import meshing\n"
    "from meshwright_core.geometry import smoothing",
    "improve": "from meshwright_agent.policy import policy_files\n"
    "from meshwright_agent.search import solver\n"
    "policy_files.load(policy_files.shipped('quad')[0])",
}


def run(seed: int, quick: bool, update: Update) -> dict[str, Any]:
    """Measure both commands; ``quick`` leaves ``improve`` out."""
    found: dict[str, Any] = {"unit": "seconds", "cores": os.cpu_count()}
    with tempfile.TemporaryDirectory() as folder:
        mesh, better = str(Path(folder) / "star.vtk"), str(Path(folder) / "better.vtk")
        commands = {
            "mesh": ["mesh", "star", "-o", mesh],
            "improve": ["improve", mesh, "-o", better, "--rollouts", "1", "--seed", str(seed)],
        }
        environment = {**os.environ, "MESHWRIGHT_CACHE_DIR": str(Path(folder) / "kernels")}
        for name in ("mesh",) if quick else ("mesh", "improve"):
            update(0, f"{name}, cold")
            words = [sys.executable, "-m", "meshwright", *commands[name]]
            row = {"cold": _measured(words, environment)}
            for _ in range(1 if quick else ROUNDS):
                update(0, f"{name}, warm")
                warm = _measured(words, environment)
                row["warm"] = min(row.get("warm", warm), warm, key=lambda one: one["clock"])
            row["of it imports"] = _measured([sys.executable, "-c", _IMPORTS[name]], environment)
            found[name] = row
    return found


def _measured(words: list[str], environment: dict[str, str]) -> dict[str, float]:
    """Run a command to its end; seconds by the clock and of the processor."""
    before, began = os.times(), time.perf_counter()
    subprocess.run(words, env=environment, check=True, capture_output=True)
    clock, after = time.perf_counter() - began, os.times()
    used = after.children_user - before.children_user
    used += after.children_system - before.children_system
    return {"clock": round(clock, 2), "processor": round(used, 2)}
