"""Checks of lesson 4: local and global operations of quads."""

from __future__ import annotations

import numpy as np

from meshwright.teaching.exercises.answer_parsing import (
    edited_mesh,
    mesh_of,
    require,
    whole_number,
    yes_or_no,
)
from meshwright.teaching.exercises.exercise import declare


@declare("4.1", "Follow the edge in the picture until it stands where it stood.")
def turns(answer: object) -> str:
    """Flips to the left until the edge is back."""
    n = whole_number(answer)
    require(n != 6, "The hexagon has six corners, but an edge has no head: look after half a turn.")
    require(n != 2, "Two flips of a triangle edge do it. In the hexagon the edge has more places.")
    require(n == 3, "Count the places that the edge can have in the hexagon.")
    return "Three places, so three flips to the left, or one to the right after one to the left."


@declare("4.2", "Write down the four numbers after the split, that of the new vertex too.")
def split_change(answer: object) -> str:
    """The change of s by a split with a +2, d -1, f -1."""
    n = whole_number(answer)
    require(n != -3, "The new vertex counts too: it has three edges, and four are desired.")
    require(n != 2, "Give it as a change: after minus before.")
    require(n == -2, "a loses one, d and f gain one each, and a vertex of degree 3 is new.")
    return "4 before; +1, 0, 0 and the new -1 after: 2."


@declare("4.3", "The blue -2 is the doublet. Collapse one of its two quads so that it goes.")
def doublet(widget: object) -> str:
    """A doublet is removed, and the grid is regular."""
    mesh = edited_mesh(widget)
    inside = mesh.vertices()[~mesh.boundary()[mesh.vertices()]]
    require(
        not np.any(mesh.degree()[inside] == 2),
        "There is still a vertex inside with only two edges.",
    )
    require(
        mesh.score == 0,
        f"The doublet is gone, but s is {mesh.score}. Undo, and merge the doublet with the corner "
        "across, not its two neighbours with each other.",
    )
    return "The doublet merged with the corner across, and its two quads are one again."


@declare("4.4", "Remember what a flip, a split and a collapse do to the boundary: nothing.")
def local_is_enough(answer: object) -> str:
    """Whether local operations can make the rectangle regular."""
    require(
        not yes_or_no(answer),
        "A regular mesh of a rectangle is a grid, with as many edges above as below. Which local "
        "operation puts a vertex on the boundary?",
    )
    return "Three edges below and one above stay three and one: no grid has that."


@declare(
    "4.5",
    "Which vertex should gain an edge, and which lose one? The arrow has a start and an end.",
)
def three_to_one(widget: object) -> str:
    """The rectangle with unequal sides made regular."""
    mesh = mesh_of(edited_mesh(widget))
    require(
        mesh.score == 0,
        f"s is {mesh.score} now. A global split gives an edge to the vertex where the arrow "
        "starts, and takes one from the vertex where it ends: which vertex needs which?",
    )
    return "Lines were carried to the upper side, and now it has as many edges as the lower one."


@declare("4.6", "Count the lines inside: across and down.")
def lines_of_the_grid(answer: object) -> str:
    """Clean-ups of a grid of 4 by 3 quads."""
    n = whole_number(answer)
    require(n != 7, "Sides of the rectangle are not lines to be deleted; only those inside count.")
    require(n != 12, "That is the number of quads.")
    require(n == 5, "A grid of 4 by 3 quads has lines from top to bottom and from left to right.")
    return "Three down and two across; then one quad is left, and the score was 0 all the time."
