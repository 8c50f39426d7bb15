"""Calls of kernels from Python without the look-up by argument types, which outlasts an edit."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from typing import Any, cast

import numba

from meshwright_core.core.arrays import allocate


@cache
def entry(kernel: Any, integers: int) -> Callable[..., Any]:
    """What runs a kernel of a MeshArrays and so many integers.

    The look-up that it avoids asks for the type of each array and takes several microseconds.
    """
    types = (numba.typeof(allocate(3, 1, 1)), *(numba.int64,) * integers)
    return cast(Callable[..., Any], kernel.compile(types))
