"""Calls at the end of each cell, where the notebook has such events: not in marimo."""

from __future__ import annotations

import sys
from collections.abc import Callable
from weakref import WeakMethod


def on_cell_end(method: Callable[[], None]) -> Callable[[], None]:
    """Call the bound ``method`` after each cell; returns a function that ends that.

    The object of the method is not kept alive.
    """
    ipython = sys.modules.get("IPython")
    shell = ipython.get_ipython() if ipython is not None else None
    if shell is None:
        return lambda: None
    known = WeakMethod(method)

    def ended(result: object = None) -> None:
        found = known()
        if found is not None:
            found()
        else:
            forget()

    def forget() -> None:
        if ended in shell.events.callbacks["post_run_cell"]:
            shell.events.unregister("post_run_cell", ended)

    shell.events.register("post_run_cell", ended)
    return forget
