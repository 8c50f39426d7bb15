"""Fine grids of a plate with three holes, of ten thousand to a million cells, stage by stage.

The blocks are found once. Seconds are of the processor, those of all threads together, and of the
clock; the memory is the largest that the process has had up to then, Python with all its packages
included.
"""

from __future__ import annotations

import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any, TypeVar

import numpy as np

from meshwright.assistant.block_search import BlockSearch, decomposed
from meshwright.benchmarks.parts import aligned
from meshwright.console import Update
from meshwright_agent.policy import policy_files
from meshwright_core.blocks.grid import Sizing, block_grid, interpolated
from meshwright_core.blocks.sizing import division
from meshwright_core.blocks.structure import BlockStructure
from meshwright_core.domains import meshing
from meshwright_core.domains.block_parts import block_parts
from meshwright_core.io.grids.block_files import write_blocks

SUMMARY = "fine grids of 10^4 to 10^6 cells of a plate with holes: seconds and memory by stage"
SECONDS = 10.0
"""Default search time for the blocks, in seconds."""

PART = "plate with three holes"
CELLS = (10_000, 100_000, 1_000_000)
QUICK = (1_000, 4_000)
STAGES = ("counts", "interpolation", "smoothing", "measures", "writing .vtm")
Result = TypeVar("Result")


def run(seed: int, quick: bool, update: Update, seconds: float = SECONDS) -> dict[str, Any]:
    """One row for each number of cells; quick: small ones, a tenth of the time."""
    policy = policy_files.load(policy_files.shipped("quad")[0])
    domain = block_parts()[PART]
    search = BlockSearch(0.1 * seconds if quick else seconds, seed=seed)
    mesh = decomposed(meshing.mesh_domain(domain, "quad"), policy, search)
    structure = BlockStructure.of(mesh)
    block_grid(structure, Sizing(divide=12))  # loads the kernels
    rows = {}
    for number, cells in enumerate(QUICK if quick else CELLS):
        update(number, f"{cells:,} cells")
        rows[f"{cells:,}"] = measured(structure, float(np.sqrt(domain.area / cells)))
    return {"blocks": len(structure.corners), "s": mesh.score, "s*": mesh.optimum, "sizes": rows}


def measured(structure: BlockStructure, size: float) -> dict[str, Any]:
    """One grid with cells of this size."""
    spent: dict[str, float] = {}

    def timed(stage: str, work: Callable[[], Result]) -> Result:
        began = time.process_time()
        result = work()
        spent[stage] = time.process_time() - began
        return result

    began = time.perf_counter()
    sizing = Sizing(size=size)
    wanted = timed("counts", lambda: division(structure, sizing))
    timed("interpolation", lambda: interpolated(structure, wanted))
    grid = timed("smoothing", lambda: block_grid(structure, sizing))
    # the whole has made the counts and the interpolation again
    spent["smoothing"] = max(spent["smoothing"] - spent["counts"] - spent["interpolation"], 0.0)
    quality = timed("measures", lambda: grid.quality)
    with tempfile.TemporaryDirectory() as folder:
        timed("writing .vtm", lambda: write_blocks(Path(folder) / "grid.vtm", grid))
    return {
        "cells": grid.cell_count,
        **{stage: round(spent[stage], 3) for stage in STAGES},
        "all": round(sum(spent.values()), 2),
        "by the clock": round(time.perf_counter() - began, 2),
        "microseconds a cell": round(1e6 * sum(spent.values()) / grid.cell_count, 2),
        "worst Jacobian": round(quality.worst_scaled_jacobian, 3),
        "inverted": quality.inverted,
        "MiB": peak(),
    }


def peak() -> float | str:
    """The largest memory of the process so far, in MiB; "" where the system does not tell."""
    try:
        import resource
    except ImportError:  # Windows
        return ""
    unit = 1024**2 if sys.platform == "darwin" else 1024
    return round(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / unit, 0)


def text(results: dict[str, Any]) -> str:
    """Return the results as a table with the blocks below."""
    sizes = results["sizes"]
    columns = list(next(iter(sizes.values())))
    rows = [["wanted", *columns]]
    rows += [[name, *(f"{row[column]}" for column in columns)] for name, row in sizes.items()]
    blocks = f"{results['blocks']} blocks, s = {results['s']}, s* = {results['s*']}"
    return "\n".join([aligned(rows), blocks])
