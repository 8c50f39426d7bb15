"""The two kinds of mesh, and what their elements are called in messages."""

from __future__ import annotations

ELEMENT_NOUN = {"tri": "triangle", "quad": "quad"}
"""One element of a mesh of this kind."""
KIND_NOUN = {"tri": "triangles", "quad": "quads"}
"""The elements of a mesh of this kind."""
