"""Benchmarks of the notebook widget, in JupyterLab and Chromium.

A real mouse clicks at half-edges all over a scrambled mesh that is wholly in view, and the page
notes when the click came, when the request went out, when the answer was there, and when a frame
showed it. JupyterLab, Playwright and Chromium must be installed.
"""

from __future__ import annotations

import statistics
from collections.abc import Mapping, Sequence
from typing import Any

from meshwright.benchmarks.notebook.chromium import browser
from meshwright.benchmarks.notebook.jupyterlab import LabNotebook
from meshwright.benchmarks.notebook.probe import NOTING, WidgetProbe
from meshwright.benchmarks.notebook.servers import jupyterlab, need
from meshwright.console import Update, no_update

SUMMARY = "the notebook's widget in JupyterLab: click to redrawn, panning, bytes sent"
SIZES = (100, 1_000, 10_000)
"""Quads of the meshes."""
CLICKS = 40
QUICK = 3
SECONDS_OF_PANNING = 3.0
WINDOW: Any = {"width": 1280, "height": 1000}


def run(seed: int = 0, quick: bool = False, update: Update = no_update) -> dict[str, Any]:
    """Medians by number of elements; ``quick`` takes the smaller meshes and a few clicks.

    Keys of each size: ``click_to_redrawn_ms`` from the mouse button to the frame, with its parts
    ``browser`` (until the request is sent), ``python`` (from its arrival in the kernel until the
    answer is sent), ``transport`` (the rest of the way there and back, through Jupyter's server),
    ``paint`` (from the answer to the frame) and the ``slowest``; ``bytes`` of the ``patch`` alone,
    of ``all`` that Python sends for one operation, and of a whole ``state``; ``panning`` with
    painted ``frames_per_second`` and the ``slowest_frame_ms``. Raises UserError where something is
    not installed.
    """
    sizes = SIZES[:2] if quick else SIZES
    results: dict[str, Any] = {}
    need("playwright", "Playwright")  # before a server starts
    with jupyterlab() as server, browser() as chromium:
        page = chromium.new_page(viewport=WINDOW)
        page.add_init_script(NOTING)
        notebook = LabNotebook(page, server)
        for size in sizes:
            update(0, f"{size:,} elements")
            probe = WidgetProbe(notebook, size, seed)
            clicks = [probe.click() for _ in range((QUICK if quick else CLICKS) + 2)][2:]
            results[f"{size:,} elements"] = {
                "click_to_redrawn_ms": shares([click.milliseconds for click in clicks]),
                "bytes": {
                    "patch": int(statistics.median(click.patch_bytes for click in clicks)),
                    "all": int(statistics.median(click.all_bytes for click in clicks)),
                    "state": probe.state_bytes,
                },
                "panning": probe.pan(0.5 if quick else SECONDS_OF_PANNING),
            }
    return results


def shares(rows: Sequence[Mapping[str, float]]) -> dict[str, float]:
    """The median of each column, and the slowest total."""
    found = {name: round(statistics.median(row[name] for row in rows), 1) for name in rows[0]}
    return {**found, "slowest": round(max(row["total"] for row in rows), 1)}
