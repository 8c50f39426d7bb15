"""Desktop benchmarks: start-up time of the window, and response times.

Every measurement is made in a separate process that drives the window by Qt's own events. A
display is needed; where there is none and Xvfb is installed, a virtual one is started.
"""

from __future__ import annotations

import json
import subprocess
import sys
import tempfile
import time
from typing import Any

from meshwright.benchmarks.desktop.display import display
from meshwright.console import Update, no_update

SUMMARY = "start of the window, and its answers to mouse and keys"
SIZES = (1_000, 10_000, 100_000)
"""Quads of the meshes that hover and operations are measured on."""
PLAYED = 1_000
"""Quads of the mesh that the agent plays on."""
LARGEST = 1_000_000
LONGEST = 400.0


def run(seed: int = 0, quick: bool = False, update: Update = no_update) -> dict[str, Any]:
    """Seconds from the start of a process to the first paint and to the mesh on the screen, and
    milliseconds from an event to what is drawn for it.

    ``quick`` leaves out the agent and takes the smallest mesh only; ``seed`` scrambles the meshes.
    Keys: ``start`` (``first_paint_s``, ``mesh_drawn_s``, ``kernels_ready_s``, and what was loaded
    at the first paint), ``answers`` by number of quads (``hover_ms``: mouse move to painted
    half-edge, with the slowest; ``operation_ms``: key to the frame on the screen, split into the
    ``document``'s share, ``prepare`` (scene and overlay), ``frame`` (VTK) and ``show`` (Qt composes
    the window), and apart the ``first`` operation and its ``undo``; ``frames_per_hover``, which
    should be 0),
    ``play`` (operations and frames a second while the agent plays, and how long the window takes to
    answer a mouse move meanwhile), ``million`` (seconds to open, milliseconds to hover and edit).
    Raises RuntimeError without a display.
    """
    with display() as environment:
        update(0, "kernels")
        for module in ("meshwright_core.warm_up", "meshwright_agent.warm_up"):
            subprocess.run([sys.executable, "-m", module], check=True, capture_output=True)
        update(1, "start")
        _probe("start", environment)  # warm: the second start is the one that counts
        results: dict[str, Any] = {"start": _probe("start", environment)}
        results["answers"] = {}
        for size in SIZES[:1] if quick else SIZES:
            update(2, f"answers, {size:,} quads")
            results["answers"][f"{size:,}"] = _probe("answer", environment, size, seed)
        if not quick:
            update(3, "play")
            results["play"] = _probe("play", environment, PLAYED, seed)
            update(4, f"{LARGEST:,} quads")
            results["million"] = _probe("answer", environment, LARGEST, seed)
    return results


def _probe(what: str, environment: dict[str, str], *numbers: int) -> dict[str, Any]:
    """Run one of the measurements of :mod:`meshwright.benchmarks.desktop.probe` in a fresh
    process.
    """
    command = [sys.executable, "-m", "meshwright.benchmarks.desktop.probe", what, repr(time.time())]
    command += [str(number) for number in numbers]
    with tempfile.TemporaryDirectory() as home:  # the user's settings are neither read nor written
        apart = {**environment, "XDG_CONFIG_HOME": home, "XDG_STATE_HOME": home}
        done = subprocess.run(
            command, env=apart, capture_output=True, text=True, timeout=LONGEST, check=False
        )
    if done.returncode != 0:
        last = (done.stderr.strip() or "no message").splitlines()[-1]
        raise RuntimeError(f"The window could not be measured: {last}")
    result: dict[str, Any] = json.loads(done.stdout.splitlines()[-1])
    return result
