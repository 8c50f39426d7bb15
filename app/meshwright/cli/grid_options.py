"""The options of commands that make block grids."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING, TypeVar

from meshwright.cli import arguments as inputs
from meshwright.console import UserError

if TYPE_CHECKING:
    from meshwright_core.blocks.sizing import Sizing
    from meshwright_core.io.grids.openfoam import Extrusion

Number = TypeVar("Number", int, float)

GROWTH = 1.2
"""Ratio of a layer where none is given."""


def add_grid_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments that :func:`sizing` and :func:`extrusion` read, and ``--order``."""
    size = parser.add_mutually_exclusive_group()
    size.add_argument(
        "--size", metavar="H", type=inputs.positive_float,
        help="length of a cell; left out, it follows from size, curves and gaps of the domain",
    )  # fmt: skip
    size.add_argument(
        "--divide", metavar="N", type=inputs.positive_int, help="N cells along every block edge"
    )
    parser.add_argument(
        "--side-size", metavar="NAME:H", action="append", default=[],
        help="length of a cell on a named side; may be repeated",
    )  # fmt: skip
    parser.add_argument(
        "--count", metavar="NAME:N", action="append", default=[],
        help="N cells on a named side in all; may be repeated",
    )  # fmt: skip
    parser.add_argument(
        "--wall", metavar="NAME:HEIGHT[:RATIO]", action="append", default=[],
        help="layers at a named side, or at all: the first cell has this height, and the next ones "
        f"grow by this ratio ({GROWTH}); may be repeated",
    )  # fmt: skip
    parser.add_argument(
        "--order", type=int, choices=(1, 2, 3), default=1,
        help="order of the cells: 2 in .msh, .vtu and .inp, 3 in .msh and .vtu (1)",
    )  # fmt: skip
    parser.add_argument(
        "--extrude", nargs=2, metavar=("H", "N"),
        help="blockMeshDict: a thickness of H in N layers, in place of one cell for plane flow",
    )  # fmt: skip
    parser.add_argument(
        "--wedge", action="store_true",
        help="blockMeshDict: a wedge around the x axis, for axially symmetric flow",
    )  # fmt: skip


def sizing(arguments: argparse.Namespace) -> Sizing:
    """The numbers of cells wanted. Raises UserError for an option that cannot be read."""
    from meshwright_core.blocks.sizing import Sizing, WallLayer
    from meshwright_core.errors import MeshError

    sizes: dict[str, float] = {}
    counts: dict[str, int] = {}
    walls = []
    for text in arguments.side_size:
        name, value = _named(text, "--side-size", "NAME:H")
        sizes[name] = _once(sizes, name, _number(value, "--side-size", text), "--side-size")
    for text in arguments.count:
        name, value = _named(text, "--count", "NAME:N")
        number = _number(value, "--count", text)
        if number != int(number):
            raise UserError(f"--count {text}: {value} is not a whole number")
        counts[name] = _once(counts, name, int(number), "--count")
    for text in arguments.wall:
        words = text.split(":")
        if len(words) not in (2, 3) or not words[0]:
            raise UserError(f"--wall {text}: this is not of the form NAME:HEIGHT[:RATIO]")
        ratio = _number(words[2], "--wall", text) if len(words) == 3 else GROWTH
        try:
            walls.append(WallLayer(words[0], _number(words[1], "--wall", text), ratio))
        except MeshError as error:
            raise UserError(f"--wall {text}: {str(error).rstrip('.')}") from error
    if arguments.divide is not None and sizes:
        raise UserError("--divide and --side-size exclude each other")
    return Sizing(arguments.size, sizes, arguments.divide, tuple(walls), counts)


def extrusion(arguments: argparse.Namespace) -> Extrusion | None:
    """How the plane becomes a volume. Raises UserError for an option that cannot be read."""
    from meshwright_core.io.grids.openfoam import Extrusion

    if arguments.extrude is None:
        return Extrusion(wedge=True) if arguments.wedge else None
    if arguments.wedge:
        raise UserError("--extrude and --wedge exclude each other")
    height, layers = arguments.extrude
    text = f"{height} {layers}"
    value, number = _number(height, "--extrude", text), _number(layers, "--extrude", text)
    if number != int(number) or number < 1:
        raise UserError(f"--extrude {text}: {layers} is not a whole number of at least 1")
    return Extrusion(value, int(number))


def _once(known: dict[str, Number], name: str, value: Number, option: str) -> Number:
    """The value; raises UserError where the side has another one."""
    if known.get(name, value) != value:
        raise UserError(f"{option} {name}: given twice, as {known[name]:g} and {value:g}")
    return value


def _named(text: str, option: str, form: str) -> tuple[str, str]:
    name, colon, value = text.rpartition(":")
    if not colon or not name:
        raise UserError(f"{option} {text}: this is not of the form {form}")
    return name, value


def _number(text: str, option: str, whole: str) -> float:
    try:
        return inputs.positive_float(text)
    except argparse.ArgumentTypeError as error:
        raise UserError(f"{option} {whole}: {error}") from None
    except ValueError:
        raise UserError(f"{option} {whole}: {text} is not a number") from None
