"""Checks of lesson 1: half-edges and degrees."""

from __future__ import annotations

from meshwright.teaching.exercises.answer_parsing import (
    edited_mesh,
    require,
    result_of,
    whole_number,
)
from meshwright.teaching.exercises.example_meshes import fan, grid
from meshwright.teaching.exercises.exercise import declare

STAR = 24
"""Quads of the star of the gallery."""


@declare("1.1", "How many sides does each of the 24 quads own? Put the number where the dots are.")
def halfedges_of_the_star(answer: object) -> str:
    """Half-edges of 24 quads."""
    n = whole_number(answer)
    require(
        n != STAR, "That is the number of quads. Each of them owns one half-edge for each side."
    )
    require(
        n != 58,
        "That is the number of edges; an edge between two quads has two half-edges.",
    )
    require(n == 4 * STAR, "Count by quads, not by edges: no half-edge belongs to two quads.")
    return "Each quad owns four, whether its neighbours are there or not: 4 \u00b7 24 = 96."


@declare("1.2", "Start at half-edge 5 in the picture and take three steps along the arrows.")
def three_steps(answer: object) -> str:
    """Three times next from 5."""
    n = whole_number(answer)
    require(n != 8, "After 7 there is no half-edge 8 in this quad: the walk closes.")
    require(n != 7, "That is where two steps end; one is missing.")
    require(n != 5, "That is where four steps end: all the way round.")
    require(n == 4, "Stay inside the right-hand quad and follow its arrows, head to tail.")
    return "Three times `next` in a quad is once `prev`: 5, 6, 7, 4."


@declare("1.3", "Look at mesh.twin(h) of each half-edge: what is it where there is no twin?")
def count_boundary(function: object) -> str:
    """A function that counts half-edges without twin."""
    for mesh, name in (
        (grid(2, 1), "the pair"),
        (grid(3, 2), "a grid of 3 by 2 quads"),
        (fan(), "a fan of triangles"),
    ):
        n = whole_number(result_of(function, mesh), "what the function returns")
        wanted = int(mesh.boundary().sum())
        require(
            n != mesh.k * mesh.n_elements - wanted,
            "These are the half-edges that have a twin; it is the others that are wanted.",
        )
        require(n == wanted, f"On {name} it returns {n}; count the sides of its outline by hand.")
    return "A half-edge without a twin lies on the boundary, and each boundary edge has just one."


@declare("1.4", "From h go to the half-edge that ends where h starts, then to its other side.")
def turn(function: object) -> str:
    """The next half-edge out of the same vertex, counter-clockwise."""
    for mesh, h in ((grid(2, 2), grid(2, 2).halfedge(4, 5)), (fan(), fan().halfedge(0, 1))):
        here, wanted = mesh.origin(h), mesh.twin(mesh.prev(h))
        found = whole_number(result_of(function, mesh, h), "what the function returns")
        require(
            0 <= found < mesh.k * mesh.n_elements,
            f"It returns {found}: no half-edge here has that id.",
        )
        require(found != h, "It returns h itself.")
        require(
            mesh.origin(found) == here,
            f"From the vertex {here} it comes to a half-edge that leaves {mesh.origin(found)}: "
            "the two must start at the same vertex.",
        )
        require(
            found == wanted,
            "It turns about the vertex, but clockwise; try the two steps in "
            "the other order, with `prev`.",
        )
    return "Repeat it and you meet every edge at the vertex once: that is how a degree is counted."


@declare("1.5", "Add the five numbers without their signs.")
def score(answer: object) -> str:
    """s of +1, -1, -2, +1, 0."""
    n = whole_number(answer)
    require(n != -1, "That is the sum with signs, the topic of the next lesson. s ignores signs.")
    require(n != 4, "That is how many vertices are irregular; one of them counts twice.")
    require(n == 5, "Take each number without its sign, then add.")
    return (
        "1 + 1 + 2 + 1 + 0: too many and too few edges count alike, and two too few count double."
    )


@declare(
    "1.6", "Point at the edge between the two vertices with an edge too many, and read the panel."
)
def one_flip(widget: object) -> str:
    """A grid that one flip makes regular."""
    mesh = edited_mesh(widget)
    require(
        mesh.score == 0,
        f"s is {mesh.score} now, and some discs are left. Undo, and flip the other way.",
    )
    return "Every vertex has its desired degree: s is 0, the lowest possible."
