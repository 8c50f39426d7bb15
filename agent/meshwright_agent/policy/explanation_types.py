"""What a policy is seen to think at one state of a mesh: plain data, for people who watch it.

No torch here: whoever shows an insight need not import what made it.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from meshwright_core.operations.catalogue import Operation


@dataclass(frozen=True)
class Choice:
    """One operation that a policy may take."""

    operation: Operation
    halfedge: int
    probability: float
    """From 0 to 1, among all that was looked at."""
    change: int
    """The exact change of s that it makes."""


@dataclass(frozen=True, eq=False)
class Insight:
    """What a policy sees, and what it wants, before it takes a decision.

    All ids are those of the mesh that it looks at.
    """

    choices: tuple[Choice, ...]
    """The operations it weighs, the likeliest first; those with the same result are one."""
    wanted: Choice
    """The one that it will take; drawn by these probabilities, so not always the likeliest."""
    halfedges: np.ndarray
    """(K,) int64: the half-edges among which it chooses."""
    weights: np.ndarray
    """(K,) float64: the probability of each of them, over all its operations."""
    template: np.ndarray
    """(T, 3) int64: the template of the wanted half-edge (section 4.2.1), a row for each vertex in
    the order in which it is met: vertex, slot, and ring, 0 for the element itself."""
    missing: int
    """Slots of the template that lie beyond the boundary."""
    field: np.ndarray
    """(M, 2) int64: elements that the embedding of the wanted half-edge depends on, and after how
    many blocks of convolution each comes in; the nearest first."""
    value: float
    """What its value head expects of the normalised return; means nothing where the policy was
    trained without a baseline."""
