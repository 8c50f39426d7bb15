"""Checks of lesson 5: the blocks of a quad mesh."""

from __future__ import annotations

import numpy as np

from meshwright.teaching.exercises.answer_parsing import (
    edited_mesh,
    require,
    result_of,
    whole_number,
)
from meshwright.teaching.exercises.exercise import declare
from meshwright_core.analysis.block_grids import Grid
from meshwright_core.analysis.blocks import block_count

NOTCH = 4
"""Blocks that the notch needs."""


@declare(
    "5.1", "A block ends where a line from an irregular vertex cuts. Which vertex is one here?"
)
def regular_grid(answer: object) -> str:
    """Blocks of a regular grid."""
    n = whole_number(answer)
    require(n != 12, "That is the number of quads. What would cut one of them from the next?")
    require(n != 4 and n != 3, "Columns and rows are not cut apart: no cut begins anywhere here.")
    require(n == 1, "Look for a vertex where a cut could begin, and count how many cuts there are.")
    return "No cut begins anywhere, so all 12 quads are one block."


@declare("5.2", "Point at a half-edge of a line inside a block, and press X.")
def bare_l(widget: object) -> str:
    """An L with nothing left that a clean-up can take."""
    mesh = edited_mesh(widget)
    require(
        mesh.score == mesh.optimum,
        f"s is {mesh.score} now, and it was 0. Undo: a clean-up of a line leaves the score alone.",
    )
    require(
        block_count(mesh) == 3,
        f"There are {block_count(mesh)} blocks now. Undo until there are three; continue with X.",
    )
    require(
        mesh.n_elements == 3,
        f"{mesh.n_elements} quads are left; each block may become a single one.",
    )
    return "Six lines went, and the three blocks are still there: a quad each."


@declare("5.3", "How many corners turn inwards, and do any two of them share a cut?")
def blocks_of_the_u(answer: object) -> str:
    """Blocks of a U-shape."""
    n = whole_number(answer)
    require(n != 3, "That is where you would cut by eye; but each inward corner makes two cuts.")
    require(
        n != 4,
        "A shared cut would save one, as in the T. But the line from one inward corner of the U "
        "straight to the other is on the boundary: it is no cut.",
    )
    require(n == 5, "Begin with one piece, and add one for each cut.")
    return "Two inward corners make two cuts each, none is shared: 1 + 4."


@declare("5.4", "An array of m + 1 rows of vertices has m rows of quads between them.")
def quads_of_a_grid(function: object) -> str:
    """The number of quads by the shape of the array of vertices."""
    for rows, columns in ((3, 4), (1, 1), (2, 7)):
        vertices = np.arange((rows + 1) * (columns + 1)).reshape(rows + 1, columns + 1)
        elements = np.arange(rows * columns).reshape(rows, columns)
        n = whole_number(
            result_of(function, Grid(vertices, elements, False)), "what the function returns"
        )
        require(n != vertices.size, "That many vertices there are. Quads lie between them.")
        require(
            n == rows * columns,
            f"For {rows + 1} rows of {columns + 1} vertices it returns {n}; draw them, and count "
            "the quads.",
        )
    return "One less than the vertices, both ways."


@declare("5.5", "Play until s is at the optimum; then take lines out with X as long as you can.")
def notch(widget: object) -> str:
    """The notch at its optimum, in few blocks."""
    mesh = edited_mesh(widget)
    require(
        mesh.score == mesh.optimum,
        f"s is {mesh.score} and the optimum {mesh.optimum}. Stuck? `Hint` shows what the agent "
        "would do, `Complete` does it all.",
    )
    count = block_count(mesh)
    require(
        count <= NOTCH + 2,
        f"At the optimum, with {count} blocks. Lines that are not needed can go: try "
        "`notch.clean_all()`.",
    )
    if count > NOTCH:
        return f"{count} blocks. {NOTCH} are enough, as the next picture shows."
    return f"{count} blocks, and no mesh of the notch at its optimum has fewer."


@declare("5.6", "The Euler characteristic of a shape with one hole is 0. How many cuts are there?")
def square_with_hole(answer: object) -> str:
    """Blocks of a square with a square hole when no cut is shared."""
    n = whole_number(answer)
    require(n != 9, "With a hole the count does not begin with one piece: \u03c7 is 0.")
    require(
        n != 4,
        "The desired degree of each corner of the hole is 4; two of the edges are its boundary.",
    )
    require(n == 8, "\u03c7, and one for each cut. Every corner of the hole makes two.")
    return "0 + 8: four corners of the hole, two cuts each."
