"""Descriptions of a policy's decisions, as plain data that is shown to people.

Does not import PyTorch, so that the user interface can import it cheaply.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from meshwright_core.operations.catalogue import Operation


@dataclass(frozen=True)
class PolicyAction:
    """One operation that a policy may take, with its probability."""

    operation: Operation
    halfedge: int
    probability: float
    """From 0 to 1, among all operations of the decision."""
    change: int
    """The exact change of s."""


@dataclass(frozen=True, eq=False)
class Insight:
    """The basis of a policy's next decision. All ids are those of the mesh in its present state."""

    choices: tuple[PolicyAction, ...]
    """The permitted operations, likeliest first; those with the same result are merged."""
    wanted: PolicyAction
    """The operation that was sampled and will be applied; not always the likeliest."""
    halfedges: np.ndarray
    """(K,) int64: the candidate half-edges."""
    weights: np.ndarray
    """(K,) float64: the probability of each candidate, summed over its operations."""
    template: np.ndarray
    """(T, 3) int64: the template of the sampled operation's half-edge (section 4.2.1). One row per
    vertex, in the order of the slots: vertex, slot, and ring, 0 for the element itself."""
    missing: int
    """Number of slots of the template that lie beyond the boundary."""
    field: np.ndarray
    """(M, 2) int64: the elements on which the embedding of that half-edge depends, and the block of
    convolution that adds each; nearest first."""
    value: float
    """The predicted normalised return; meaningless if the policy has no trained baseline."""
