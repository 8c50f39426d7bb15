"""Flags of vertices that compiled code does not read: pins.

A pinned vertex is one that a person has put where it is. Smoothing does not move it; operations may
delete it, which they do not with a locked one.
"""

from __future__ import annotations

from meshwright_core.core.arrays import GEOMETRIC, LOCKED

PINNED = 4
"""The bit of a pinned vertex, beside GEOMETRIC and LOCKED."""
UNMOVED = GEOMETRIC | LOCKED | PINNED
"""Vertices with any of these bits are not moved by smoothing."""
