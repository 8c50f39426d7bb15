"""Checks of lesson 3: flip, split and collapse of triangles."""

from __future__ import annotations

from meshwright.teaching.exercises.answer_parsing import (
    edited_mesh,
    require,
    result_of,
    whole_number,
    whole_numbers,
)
from meshwright.teaching.exercises.example_meshes import hexagon, trap
from meshwright.teaching.exercises.exercise import declare


@declare("3.1", "Write down the four new numbers first; then compare the sums of absolute values.")
def flip_change(answer: object) -> str:
    """The change of s by a flip with +2, 0, -1, -1."""
    n = whole_number(answer)
    require(n != 2, "That much is gained, but give it as a change: after minus before.")
    require(n != -4, "Is every vertex nearer to its desired degree? Look at b once more.")
    require(n != 0, "The sum with signs stays; s, the sum of absolute values, does not.")
    require(n == -2, "a and b each lose an edge, c and d each gain one.")
    return "4 before; +1, -1, 0, 0 and so 2 after: b gets worse by 1, the others better by 3."


@declare("3.2", "Draw a boundary edge with its triangle, put a vertex on it, and count.")
def boundary_split(vertices: object, edges: object, triangles: object) -> str:
    """V, E, F of the split of a boundary edge."""
    v, e, f = whole_numbers([vertices, edges, triangles], 3)
    require(v == 1, "One vertex is put on the edge. How many more than before are there?")
    require(f != 2, "That is the split of an edge between two triangles; here there is only one.")
    require(f == 1, "The triangle is cut in two. How many more are there than before?")
    require(e == 2, "The edge becomes two, and the new vertex is joined to the corner across.")
    return "One vertex, two edges, one triangle more: V - E + F stays what it was."


@declare("3.3", "One of the four edges at the blue vertex has to go. Undo costs nothing.")
def undone_by_collapse(widget: object) -> str:
    """A split taken back by a collapse."""
    mesh = edited_mesh(widget)
    require(
        mesh.n_vertices == 19,
        f"There are {mesh.n_vertices} vertices; before the split there were 19.",
    )
    require(
        mesh.score == 0,
        "The count is right, but some vertices are irregular: another edge went. Undo, and "
        "think which two vertices were one before the split.",
    )
    return "Collapse is the inverse of split, if it is the right edge that goes."


@declare("3.4", "mesh.neighbours(v) lists the vertices around v; a set has the sign & for both.")
def common_neighbours(function: object) -> str:
    """How many vertices both ends of an edge are joined to."""
    for mesh, a, b in (
        (hexagon(), 9, 10),
        (hexagon(), 0, 1),
        (trap(), 9, 10),
        (trap(), 10, 14),
    ):
        h = mesh.halfedge(a, b)
        if h < 0:
            h = mesh.halfedge(b, a)
        n = whole_number(result_of(function, mesh, h), "what the function returns")
        wanted = len(set(mesh.neighbours(a)) & set(mesh.neighbours(b)))
        require(
            n == wanted,
            f"For the edge {a}-{b} of a mesh of {mesh.n_elements} triangles it returns {n}: list "
            "the neighbours of both ends by hand, and count those that are in both lists.",
        )
    return "Two inside and one on the boundary: then the edge may go. One more, and it may not."


@declare(
    "3.5", "No single flip helps. Look for one that costs nothing and brings the discs together."
)
def two_flips(widget: object) -> str:
    """A hexagon that two flips make regular."""
    mesh = edited_mesh(widget)
    require(mesh.score == 0, f"s is {mesh.score} now. Undo takes you back, as far as you like.")
    return (
        "The first move gained nothing, and without it there was no second: look two steps ahead."
    )
