"""Makes every picture that README shows, from the program itself, into docs/images/.

    python docs/make_pictures.py              all of them
    python docs/make_pictures.py operations   only these: demo, operations, gallery,
                                              gallery-blocks, parts, curves, window

Only the window needs a display; with a virtual screen run
``xvfb-run -s "-screen 0 1920x1200x24" python docs/make_pictures.py window``.
"""

import argparse
import math
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image, ImageDraw

from meshwright.graphics.drawing import Drawing, Text, raster
from meshwright.graphics.export.filmstrip import side_by_side
from meshwright.graphics.mesh_figure import FigureOptions, figure, fitted
from meshwright.graphics.theme import LIGHT
from meshwright.graphics.viewport import Viewport
from meshwright_core import HalfEdgeMesh, Operation
from meshwright_core.analysis import blocks
from meshwright_core.domains import gallery, random_parts
from meshwright_core.domains.meshing import mesh_domain
from meshwright_core.geometry import quality, smoothing
from meshwright_core.geometry.shape_bound import shape_bound
from meshwright_core.operations.catalogue import CATALOGUE, OperationInfo

IMAGES = Path(__file__).parent / "images"
RENDER = 1500
"""Size in pixels of the square figure from whose middle the picture is cropped."""
PANEL = (560, 460)
GAP = 120
TILE, CAPTION = (360, 300), 30
"""Size of a shape of the gallery, and height of the text below it."""
PARTS_SEED, PARTS_SECONDS = 1, 10.0
CURVED = (
    "plate-with-round-hole", "filleted-bracket", "duct-bend", "nozzle",
    "pipe", "airfoil-in-box", "plate-with-insert", "motor-segment",
)  # fmt: skip


def triangles(rings: int) -> HalfEdgeMesh:
    """Return a hexagon of equilateral triangles; its six corners are geometric."""
    places = [
        (i, j)
        for j in range(-rings, rings + 1)
        for i in range(-rings, rings + 1)
        if abs(i + j) <= rings
    ]
    number = {place: n for n, place in enumerate(places)}
    cells = []
    for i, j in places:
        right, up, left = (i + 1, j), (i, j + 1), (i - 1, j + 1)
        for corners in ([(i, j), right, up], [(i, j), up, left]):
            if all(corner in number for corner in corners):
                cells.append([number[corner] for corner in corners])
    points = [(i + 0.5 * j, math.sqrt(0.75) * j) for i, j in places]
    return HalfEdgeMesh.from_elements(np.array(points), np.array(cells))


def quads(columns: int, rows: int) -> HalfEdgeMesh:
    """Return a grid of unit squares; its corners are geometric."""
    points = [(i, j) for j in range(rows + 1) for i in range(columns + 1)]
    cells = []
    for j in range(rows):
        for i in range(columns):
            a = j * (columns + 1) + i
            cells.append((a, a + 1, a + columns + 2, a + columns + 1))
    return HalfEdgeMesh.from_elements(np.array(points, dtype=float), np.array(cells))


def patch(info: OperationInfo) -> HalfEdgeMesh:
    """Return the small mesh on which an operation is shown."""
    if info.kind == "tri":
        return triangles(2)
    if info.operation is Operation.CLEANUP:
        return quads(4, 2)
    if info.operation is Operation.INSERT_RING:
        return mesh_domain(gallery.shape("plate-with-round-hole"), "quad")
    return quads(4, 3)


def most_central(mesh: HalfEdgeMesh, operation: Operation) -> int:
    """Return the half-edge nearest to the middle of the mesh where the operation is allowed."""
    middle = mesh.points[mesh.vertices()].mean(axis=0)
    allowed = [
        h
        for element in mesh.element_ids()
        for h in range(mesh.k * element, mesh.k * (element + 1))
        if mesh.check(operation, h)
    ]
    if not allowed:
        raise ValueError(f"{operation.value} is allowed nowhere on its patch")

    def distance(h: int) -> float:
        ends = mesh.points[[mesh.origin(h), mesh.target(h)]]
        return float(np.linalg.norm(ends.mean(axis=0) - middle))

    return min(allowed, key=distance)


def plain(mesh: HalfEdgeMesh, size: tuple[int, int], view: Viewport | None = None) -> Any:
    """Return the picture of a mesh without text."""
    return raster(figure(mesh, FigureOptions(size, score=False), viewport=view))


def panel(mesh: HalfEdgeMesh, view: Viewport, arrow: int | None = None) -> Any:
    """Return the picture of a patch, with an arrow on one half-edge."""
    drawn = plain(mesh, (RENDER, RENDER), view)
    if arrow is not None:
        a, b = view.to_screen(mesh.points[[mesh.origin(arrow), mesh.target(arrow)]])
        draw_arrow(drawn, a, b)
    left, top = (RENDER - PANEL[0]) // 2, (RENDER - PANEL[1]) // 2
    return drawn.crop((left, top, left + PANEL[0], top + PANEL[1]))


def draw_arrow(image: Any, a: np.ndarray, b: np.ndarray, colour: str = LIGHT.arrow) -> None:
    """Draw the arrow of the half-edge from a to b just inside its element, on the left of it."""
    fine = 4
    along = (b - a) / np.linalg.norm(b - a)
    inward = np.array([along[1], -along[0]])  # left of the direction, y pointing down
    length = float(np.linalg.norm(b - a))
    tail = a + 0.17 * length * along + 0.11 * length * inward
    tip = b - 0.17 * length * along + 0.11 * length * inward
    neck = tip - 26.0 * along
    overlay = Image.new("RGBA", (image.width * fine, image.height * fine), colour + "00")
    draw = ImageDraw.Draw(overlay)
    draw.line([tuple(fine * tail), tuple(fine * neck)], fill=colour, width=8 * fine)
    head = [tip, neck + 13.0 * inward, neck - 13.0 * inward]
    draw.polygon([tuple(fine * p) for p in head], fill=colour)
    smooth = overlay.resize(image.size, Image.Resampling.LANCZOS)
    image.paste(smooth, (0, 0), smooth)


def gap(height: int) -> Any:
    """Return the image between before and after: an arrow."""
    fine = 4
    image = Image.new("RGB", (GAP * fine, height * fine), LIGHT.background)
    draw = ImageDraw.Draw(image)
    y, left, right = height * fine // 2, 30 * fine, (GAP - 30) * fine
    draw.line([(left, y), (right - 14 * fine, y)], fill=LIGHT.muted, width=5 * fine)
    head = [(right, y), (right - 18 * fine, y - 11 * fine), (right - 18 * fine, y + 11 * fine)]
    draw.polygon(head, fill=LIGHT.muted)
    return image.resize((GAP, height), Image.Resampling.LANCZOS)


def operation_picture(info: OperationInfo) -> Any:
    """Return the pictures of a patch before and after an operation, side by side."""
    mesh = patch(info)
    view = Viewport(size=PANEL).fitted(mesh.points, 44.0)
    view = Viewport(view.centre, view.pixels, (RENDER, RENDER))
    h = most_central(mesh, info.operation)
    before = panel(mesh, view, h)
    mesh.apply(info.operation, h)
    smoothing.relax(mesh)
    return side_by_side([before, gap(PANEL[1]), panel(mesh, view)])


def make_operations() -> None:
    """One picture for every operation of the catalogue."""
    folder = IMAGES / "operations"
    folder.mkdir(exist_ok=True)
    for info in CATALOGUE:
        save(operation_picture(info), folder / f"{info.kind}-{info.operation.value}.png")


def make_gallery() -> None:
    """Every shape of the gallery as a quad mesh, as generated, in rows of five."""
    tiles = [plain(mesh_domain(domain, "quad"), TILE) for domain in gallery.gallery().values()]
    save(in_rows(tiles), IMAGES / "gallery.png")


def make_gallery_blocks() -> None:
    """The same as blocks, with s, the worst scaled Jacobian, their bounds, and how many."""
    from meshwright_agent.policy import policy_files
    from meshwright_agent.search.solver import solve

    policy = policy_files.load(policy_files.shipped("quad")[0])
    tiles = []
    for domain in gallery.gallery().values():
        mesh = mesh_domain(domain, "quad")
        bound = shape_bound(mesh)
        if not solve(mesh, policy, seconds=PARTS_SECONDS).carry_out(mesh):
            smoothing.relax(mesh)
        worst, count = quality.scaled_jacobian(mesh).min(), blocks.block_count(mesh)
        words = (
            f"s {mesh.score} of {mesh.optimum}   shape {worst:.2f} of {bound:.2f}   "
            f"{count} block{'s'[: count > 1]}"
        )
        tiles.append(captioned(with_blocks(mesh, TILE), words))
        sys.stdout.write(f"{domain.name}: {words}, {len(quality.inverted(mesh))} inverted\n")
    save(in_rows(tiles), IMAGES / "gallery-blocks.png")


def in_rows(tiles: list[Any], columns: int = 5) -> Any:
    """Return one image of tiles of equal size."""
    width, height = tiles[0].size
    rows = math.ceil(len(tiles) / columns)
    whole = Image.new("RGB", (columns * width, rows * height), LIGHT.background)
    for number, tile in enumerate(tiles):
        whole.paste(tile, (number % columns * width, number // columns * height))
    return whole


def captioned(image: Any, words: str) -> Any:
    """Return the image with a line of text below it."""
    line = Drawing((image.width, CAPTION), LIGHT.background)
    line.add(Text(words, (image.width / 2, CAPTION / 2), 13.0, LIGHT.text, "middle"))
    whole = Image.new("RGB", (image.width, image.height + CAPTION), LIGHT.background)
    whole.paste(image, (0, 0))
    whole.paste(raster(line), (0, image.height))
    return whole


def make_parts() -> None:
    """Random parts as generated and, below, at the optimum, cut into their blocks."""
    from meshwright_agent.policy import policy_files
    from meshwright_agent.search.solver import solve

    policy = policy_files.load(policy_files.shipped("quad")[0])
    size, columns = (300, 260), 4
    tiles: list[list[Any]] = []
    for number, domain in enumerate(random_parts.parts(2 * columns, (10, 26), seed=PARTS_SEED)):
        mesh = mesh_domain(domain, "quad")
        if number % columns == 0:
            tiles += [[], []]
        tiles[-2].append(plain(mesh, size))
        if not solve(mesh, policy, seconds=PARTS_SECONDS).carry_out(mesh):
            smoothing.relax(mesh)
        tiles[-1].append(with_blocks(mesh, size))
    whole = Image.new("RGB", (columns * size[0], len(tiles) * size[1]), LIGHT.background)
    for row, images in enumerate(tiles):
        whole.paste(side_by_side(images), (0, row * size[1]))
    save(whole, IMAGES / "parts.png")


def make_curves() -> None:
    """Shapes with curved sides as first meshed and, below, as blocks."""
    from meshwright_agent.policy import policy_files
    from meshwright_agent.search.solver import solve

    policy = policy_files.load(policy_files.shipped("quad")[0])
    size, columns = (300, 260), len(CURVED) // 2
    tiles: list[list[Any]] = []
    for number, name in enumerate(CURVED):
        mesh = mesh_domain(gallery.shape(name), "quad")
        if number % columns == 0:
            tiles += [[], []]
        tiles[-2].append(plain(mesh, size))
        if not solve(mesh, policy, seconds=PARTS_SECONDS).carry_out(mesh):
            smoothing.relax(mesh)
        tiles[-1].append(plain(mesh, size))
    whole = Image.new("RGB", (columns * size[0], len(tiles) * size[1]), LIGHT.background)
    for row, images in enumerate(tiles):
        whole.paste(side_by_side(images), (0, row * size[1]))
    save(whole, IMAGES / "curves.png")


def with_blocks(mesh: HalfEdgeMesh, size: tuple[int, int]) -> Any:
    """Return the picture of a quad mesh with the lines between its blocks drawn stronger."""
    drawn = plain(mesh, size)
    fine = 4
    view = fitted(mesh, FigureOptions(size, score=False))
    overlay = Image.new("RGBA", (fine * size[0], fine * size[1]), LIGHT.boundary + "00")
    draw = ImageDraw.Draw(overlay)
    for h in np.flatnonzero(blocks.separatrices(mesh)).tolist():
        ends = fine * view.to_screen(mesh.points[[mesh.origin(h), mesh.target(h)]])
        draw.line([tuple(end) for end in ends], fill=LIGHT.boundary, width=int(1.4 * fine))
    smooth = overlay.resize(drawn.size, Image.Resampling.LANCZOS)
    drawn.paste(smooth, (0, 0), smooth)
    return drawn


def make_demo() -> None:
    """The picture of ``meshwright demo -o``."""
    from meshwright.cli import main

    code = main(["demo", "-o", str(IMAGES / "demo.png")])
    if code != 0:
        raise RuntimeError(f"meshwright demo ended with code {code}")
    with Image.open(IMAGES / "demo.png") as image:
        save(image.convert("RGB"), IMAGES / "demo.png")


def make_window() -> None:
    """The window on the star, with the mouse over a half-edge."""
    from qtpy.QtCore import QEventLoop, QTimer

    from meshwright.desktop.main_window.startup import application, open_window

    app = application()
    window = open_window("star", "quad")
    window.resize(1360, 860)
    mesh = window.document.mesh
    pause = QEventLoop()
    QTimer.singleShot(8000, pause.quit)  # until the kernels are loaded
    pause.exec()
    window.document.hover = most_central(mesh, Operation.FLIP_LEFT)
    app.processEvents()
    path = IMAGES / "window.png"
    if not window.grab().save(str(path)):
        raise OSError(f"cannot write {path}")
    window.close()
    with Image.open(path) as image:
        save(image.convert("RGB"), path)


def save(image: Any, path: Path) -> None:
    """Write a PNG with a palette, as these pictures have few colours."""
    image.quantize(colors=256, dither=Image.Dither.NONE).save(path, optimize=True)
    sys.stdout.write(f"{path}\n")


MAKERS: dict[str, Callable[[], None]] = {
    "demo": make_demo,
    "operations": make_operations,
    "gallery": make_gallery,
    "gallery-blocks": make_gallery_blocks,
    "parts": make_parts,
    "curves": make_curves,
    "window": make_window,
}


def main() -> None:
    """Make the pictures named on the command line, or all."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("what", nargs="*", help=f"of {', '.join(MAKERS)}; all if none is named")
    names = parser.parse_args().what or list(MAKERS)
    unknown = sorted(set(names) - set(MAKERS))
    if unknown:
        parser.error(f"no such picture: {' '.join(unknown)}")
    IMAGES.mkdir(exist_ok=True)
    for name in names:
        MAKERS[name]()


if __name__ == "__main__":
    main()
