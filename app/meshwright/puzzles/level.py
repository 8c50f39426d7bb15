"""Levels: meshes with a goal and a par, to be played in the window and in the notebook.

Each is a file ``levels/NN-name.json`` of ``meshwright_assets``. It holds the mesh in full
precision, so that changes of the mesh generator do not change levels, and a solution: operations
with the ends of their half-edges.
"""

from __future__ import annotations

import difflib
from collections.abc import Iterable
from dataclasses import dataclass, field
from functools import cache
from html import escape
from pathlib import Path
from typing import Annotated, Any, Literal

import numpy as np
from msgspec import Meta, Struct

import meshwright_assets
from meshwright.document.json_records import Count, WholeNumber, decoded
from meshwright_core import HalfEdgeMesh, MeshError, Operation
from meshwright_core.core.kinds import KIND_NOUN
from meshwright_core.operations.catalogue import CODES

FOLDER = Path(meshwright_assets.__file__).parent / "levels"
VERSION = 1
LARGEST = 1000
"""Limit on the elements of a level."""
SIDES = {"tri": 3, "quad": 4}

Way = tuple[tuple[Operation, tuple[int, int]], ...]
"""Operations with the vertices where their half-edges start and end."""


@dataclass(frozen=True)
class Level:
    """One level. Row i of the arrays by vertex belongs to vertex id i of the mesh."""

    name: str
    number: int
    """Place among the levels, from 1 on."""
    title: str
    kind: str
    """``"tri"`` or ``"quad"``."""
    text: str
    """What the level teaches, in one or two sentences."""
    goal: int
    """The score to reach, s*, the lowest possible."""
    most: int
    """Limit on the elements at the goal; 0 for none."""
    par: int
    """The fewest operations known."""
    proved: bool
    """Whether an exhaustive search has proved that no fewer suffice."""
    solution: Way
    """A solution with ``par`` operations."""
    points: np.ndarray = field(compare=False, repr=False)
    """(n, 2)"""
    elements: np.ndarray = field(compare=False, repr=False)
    """(m, 3|4)"""
    corners: np.ndarray = field(compare=False, repr=False)
    """(n,) flags."""
    desired: np.ndarray = field(compare=False, repr=False)
    """(n,) desired degrees."""

    def mesh(self) -> HalfEdgeMesh:
        """A new mesh in the state where the level begins."""
        return HalfEdgeMesh.from_elements(self.points, self.elements, self.corners, self.desired)

    def reached(self, mesh: HalfEdgeMesh) -> bool:
        """Whether ``mesh`` has reached the goal."""
        return mesh.score <= self.goal and not (self.most and mesh.n_elements > self.most)

    @property
    def story(self) -> str:
        """Its number of elements, and its par."""
        return f"{len(self.elements)} {KIND_NOUN[self.kind]}, par {self.par}"

    @property
    def aim(self) -> str:
        """The goal in words."""
        if self.most:
            return f"s = {self.goal} with at most {self.most} {KIND_NOUN[self.kind]}"
        return f"s = {self.goal}"


def names() -> tuple[str, ...]:
    """The names of all levels, the easiest first."""
    return tuple(_name(path) for path in _files())


class LevelList(tuple[Level, ...]):
    """A tuple of levels that shows itself as a table."""

    def __repr__(self) -> str:
        """One line for each level: name, title, number of elements, par."""
        width = max((len(level.name) for level in self), default=0)
        return "\n".join(f"{level.name:<{width}}  {level.title}: {level.story}" for level in self)

    def _repr_html_(self) -> str:
        """The table as HTML, for notebooks."""
        cells = "".join(
            f"<tr><td>{level.number}</td><td><code>{escape(level.name)}</code></td>"
            f"<td>{escape(level.title)}</td><td>{level.story}</td></tr>"
            for level in self
        )
        return f"<table><tbody>{cells}</tbody></table>"


def all() -> LevelList:
    """All levels, the easiest first."""
    return LevelList(load(name) for name in names())


@cache
def load(name: str) -> Level:
    """The level of this name; MeshError if there is none, or if its file is not valid."""
    for number, path in enumerate(_files(), 1):
        if _name(path) == name:
            return read(path, number)
    close = difflib.get_close_matches(str(name).lower().replace("_", "-"), names(), 3, 0.5)
    hint = f"did you mean {' or '.join(close)}?" if close else f"there are {', '.join(names())}."
    raise MeshError(f"There is no level named {name!r}; {hint}")


def after(name: str) -> str | None:
    """The name of the level after this one, None after the last."""
    found = names()
    return found[found.index(name) + 1] if name in found[:-1] else None


def read(path: Path, number: int = 1) -> Level:
    """The level in a file; MeshError, one sentence that begins with the path, if it is not valid.

    The check builds the mesh and applies the solution to it.
    """
    try:
        level = _level(decoded(path.read_bytes(), _LevelFile), _name(path), number)
        _prove(level)
    except OSError as error:
        raise MeshError(f"{path}: cannot be read ({error.strerror}).") from error
    except ValueError as error:
        why = str(error).partition("\n")[0].rstrip(".")
        raise MeshError(f"{path}: this is no valid level: {why}.") from error
    return level


def record(level: Level) -> dict[str, Any]:
    """The level as plain values for JSON, as :func:`read` reads them."""
    return {
        "version": VERSION,
        "title": level.title,
        "kind": level.kind,
        "text": level.text,
        "goal": level.goal,
        "most": level.most,
        "par": level.par,
        "proved": level.proved,
        "solution": [[operation.value, a, b] for operation, (a, b) in level.solution],
        "points": level.points[:, :2].tolist(),
        "elements": level.elements.tolist(),
        "corners": np.flatnonzero(level.corners).tolist(),
        "desired": level.desired.tolist(),
    }


def play(mesh: HalfEdgeMesh, way: Way) -> None:
    """Apply the operations to ``mesh``; MeshError at the first that is refused."""
    for operation, (a, b) in way:
        mesh.apply(operation, halfedge_of(mesh, a, b))


def halfedge_of(mesh: HalfEdgeMesh, a: int, b: int) -> int:
    """The half-edge from a to b; MeshError if there is none."""
    found = mesh.halfedge(a, b)
    if found < 0:
        raise MeshError(f"no half-edge runs from vertex {a} to vertex {b}")
    return found


def way_of(mesh: HalfEdgeMesh, operations: Iterable[tuple[Operation, int]]) -> Way:
    """Operations with the vertices of their half-edges; ``mesh`` is not changed."""
    work, way = mesh.copy(), []
    for operation, halfedge in operations:
        way.append((Operation(operation), (work.origin(halfedge), work.target(halfedge))))
        work.apply(operation, halfedge)
    return tuple(way)


def _files() -> list[Path]:
    return sorted(FOLDER.glob("[0-9][0-9]-*.json"))


def _name(path: Path) -> str:
    return path.stem.partition("-")[2] or path.stem


class _LevelFile(Struct):
    """The contents of a level file."""

    version: Literal[1]
    title: Annotated[str, Meta(min_length=1)]
    kind: Literal["tri", "quad"]
    text: Annotated[str, Meta(min_length=1)]
    solution: list[tuple[str, Count, Count]]
    points: Annotated[list[tuple[float, float]], Meta(min_length=1)]
    elements: Annotated[list[list[Count]], Meta(min_length=1, max_length=LARGEST)]
    desired: list[WholeNumber]
    corners: list[Count]
    goal: Count = 0
    most: Count = 0
    par: Count = 0
    proved: bool = False


def _level(file: _LevelFile, name: str, number: int) -> Level:
    """The level that a file describes; MeshError if its parts do not fit together."""
    sides, count = SIDES[file.kind], len(file.points)
    if any(len(row) != sides for row in file.elements):
        raise MeshError(f"its field 'elements' has not {sides} vertices in each row")
    flags = np.zeros(count, bool)
    for corner in file.corners:
        if corner >= count:
            raise MeshError(f"there is no vertex {corner} to be a corner")
        flags[corner] = True
    if len(file.desired) != count:
        raise MeshError("its field 'desired' has not one number for each point")
    for operation, _, _ in file.solution:
        if operation not in CODES[sides]:
            raise MeshError(f"its field 'solution' has no operation on a half-edge, {operation!r}")
    return Level(
        name=name,
        number=number,
        title=file.title,
        kind=file.kind,
        text=file.text,
        goal=file.goal,
        most=file.most,
        par=file.par,
        proved=file.proved,
        solution=tuple((Operation(operation), (a, b)) for operation, a, b in file.solution),
        points=np.array(file.points, float),
        elements=np.array(file.elements, int),
        corners=flags,
        desired=np.array(file.desired, np.int64),
    )


def _prove(level: Level) -> None:
    """MeshError unless the solution leads to the goal in ``par`` operations."""
    mesh = level.mesh()
    if level.goal < mesh.optimum:
        raise MeshError(f"its goal is below the optimum, {mesh.optimum}")
    play(mesh, level.solution)
    if not level.reached(mesh):
        raise MeshError("its solution does not reach the goal")
    if len(level.solution) != level.par:
        raise MeshError("its solution is not as long as its par")
