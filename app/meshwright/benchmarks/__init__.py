"""The suites of ``meshwright bench``, one module each; a new module here is a new suite,
unless it is one of HELPERS.

A suite has a ``SUMMARY`` and ``run(seed, quick, update)``, which returns the numbers by name.
``quick`` does a small part of the work, as a check that the suite runs; ``update`` is called as
``update(done, remark)`` and may be ignored.

A suite that searches has ``SECONDS`` too, the time for each mesh, and takes ``seconds`` as a fourth
argument. A suite whose numbers are better read as a table has ``text(results)``, which returns it.
"""

from __future__ import annotations

import importlib
import pkgutil
from typing import Any, Protocol

from meshwright.console import Update

HELPERS = {"gmsh_peer", "hostile_files"}
"""Modules that are no suites."""


class Suite(Protocol):
    """Interface of a suite's module."""

    SUMMARY: str

    def run(self, seed: int, quick: bool, update: Update) -> dict[str, Any]:
        """Measure; return numbers by name, which may be nested."""


def names() -> list[str]:
    """Return the names of the suites without importing them."""
    found = {module.name for module in pkgutil.iter_modules(__path__)}
    return sorted(found - HELPERS)


def load(name: str) -> Suite:
    """Import one suite."""
    suite: Suite = importlib.import_module(f"{__name__}.{name}")
    return suite
