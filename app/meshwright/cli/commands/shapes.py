"""``meshwright shapes``: list the gallery, or the regions in a drawing."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING, Any

from meshwright.cli import arguments as inputs
from meshwright.cli import mesh_input
from meshwright.console import Report, UserError, table

if TYPE_CHECKING:
    from meshwright_core.io.drawings import DrawingReport

SUMMARY = "list the shapes of the gallery, or the regions in a drawing"
DESCRIPTION = (
    "List the gallery shapes, which mesh, view and demo take by name; or the regions that a "
    "drawing encloses, which mesh takes by --region, with what was mended and left out."
)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments."""
    parser.add_argument(
        "file", metavar="FILE", nargs="?", help="drawing to look into (.dxf, .svg, .geojson, ...)"
    )
    parser.add_argument(
        "--layer",
        metavar="NAME",
        action="append",
        help="look only at this layer of the drawing; may be given several times",
    )
    mesh_input.add_tracing_arguments(parser)


def run(arguments: argparse.Namespace, report: Report) -> None:
    """List each shape, or each region, with its corners and holes."""
    if arguments.file is not None:
        _regions(arguments, report)
        return
    for option in ("layer", "gap", "corner_angle", "time_limit"):
        if getattr(arguments, option) is not None:
            raise UserError(f"--{option.replace('_', '-')}: this is for a drawing; name its file")
    from meshwright_core.domains import gallery

    rows: list[dict[str, Any]] = []
    for name, domain in gallery.gallery().items():
        corners = sum(int(flags.sum()) for flags in domain.loop_corners)
        rows.append({"name": name, "corners": corners, "holes": len(domain.holes)})
    text = table([(row["name"], _words(row["corners"], row["holes"])) for row in rows], indent="")
    report.result({"command": "shapes", "shapes": rows}, text)


def _regions(arguments: argparse.Namespace, report: Report) -> None:
    from meshwright.document.storage.document_file import is_drawing
    from meshwright_core.core.irregularity import CORNER_ANGLE
    from meshwright_core.core.time_limit import SECONDS
    from meshwright_core.io import drawings

    path = arguments.file
    if not Path(path).exists():
        raise UserError(f"{path}: there is no such file")
    if not is_drawing(path):
        raise UserError(f"{path}: a file of a shape ends in one of {' '.join(drawings.endings())}")
    angle = CORNER_ANGLE if arguments.corner_angle is None else arguments.corner_angle
    seconds = arguments.time_limit or SECONDS
    with inputs.bad_input(path):
        found = drawings.read_regions(path, angle, arguments.gap, arguments.layer, seconds)
    report.result({"command": "shapes", "file": path, **found.to_json()}, _text(path, found))


def _text(path: str, found: DrawingReport) -> str:
    count = len(found.regions)
    units = f", in {found.units}" if found.units else ""
    lines = [f"{path}: {_count(count, 'region')}{units}"]
    rows = []
    for i, region in enumerate(found.regions, 1):
        words = [f"area {region.area:.6g}", _words(region.corners, region.holes)]
        if region.layer and region.layer != region.name:
            words.append(f"layer {region.layer}")
        if region.touches:
            words.append(f"touches {', '.join(str(j + 1) for j in region.touches)}")
        if region.crossing:
            words.append(region.crossing)
        rows.append((f"{i}  {region.name}", ", ".join(words)))
    lines.append(table(rows))
    lines += [f"mended: {sentence}" for sentence in found.repairs]
    lines += [f"ignored: {sentence}" for sentence in found.ignored]
    lines += [f"open: {sentence}" for sentence in found.open_outlines]
    return "\n".join(lines)


def _words(corners: int, holes: int) -> str:
    words = _count(corners, "corner") if corners else "round"
    return words + (f", {_count(holes, 'hole')}" if holes else "")


def _count(number: int, noun: str) -> str:
    return f"{number} {noun}" if number == 1 else f"{number} {noun}s"
