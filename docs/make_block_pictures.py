"""Makes the pictures of docs/blocks.md: five tutorial cases as grids, and the window's Blocks view.

    xvfb-run -s "-screen 0 1920x1200x24" python docs/make_block_pictures.py

Each case is meshed, searched for ten seconds and divided; the picture shows the cells, and the
edges of blocks thick. It prints the rows of the table of docs/blocks.md. The window, which needs a
display, shows the cylinder; `--grids` leaves it out.
"""

import sys
from pathlib import Path

import matplotlib
import numpy as np
from matplotlib import pyplot
from matplotlib.collections import LineCollection
from PIL import Image

from meshwright.assistant.block_search import BlockSearch, decomposed
from meshwright_agent.policy import policy_files
from meshwright_core import HalfEdgeMesh
from meshwright_core.blocks.grid import BlockGrid, Sizing, WallLayer, block_grid
from meshwright_core.core.grid_plan import GridPlan, Wall
from meshwright_core.domains.block_parts import TUTORIAL_BLOCKS, block_parts
from meshwright_core.domains.meshing import mesh_domain

IMAGES = Path(__file__).parent / "images" / "blocks"
SECONDS = 10.0
CELLS = 2400
COLOURS = 160
WALLS = {"cylinder in a channel": "cylinder", "airfoil with a wake": "wing"}
WINDOW = "cylinder in a channel"


def picture(grid: BlockGrid, path: Path) -> None:
    """Write the picture of a grid."""
    matplotlib.use("Agg")
    points = grid.points[:, :2]
    lines, edges = [], []
    for block in range(len(grid.shapes)):
        at = points[grid.block_vertices(block)]
        lines += [*at, *at.swapaxes(0, 1)]
    for edge in range(len(grid.structure.edges)):
        if grid.structure.parts.curve[edge] < 0:
            edges.append(points[grid.edge_vertices(edge)])
        else:
            w = np.linspace(0.0, 1.0, 200)
            edges.append(grid.structure.parts.points(np.full(len(w), edge), w)[:, :2])
    width, height = np.ptp(points, axis=0)
    size = (7.0, max(7.0 * height / width, 1.6))
    figure, axes = pyplot.subplots(figsize=size, dpi=100)
    axes.add_collection(LineCollection(lines, colors="#8aa0b8", linewidths=0.5))
    axes.add_collection(LineCollection(edges, colors="#0b3d6e", linewidths=1.8))
    axes.set_aspect("equal")
    axes.autoscale()
    axes.axis("off")
    figure.tight_layout(pad=0.2)
    figure.savefig(path)
    pyplot.close(figure)
    reduce_colours(path)


def reduce_colours(path: Path) -> None:
    """Write a PNG again with a palette, as these pictures have few colours."""
    with Image.open(path) as image:
        reduced = image.convert("RGB").quantize(COLOURS)
    reduced.save(path, optimize=True)


def make_grids() -> dict[str, HalfEdgeMesh]:
    """Make the five pictures, print the table, and return the blocks by name."""
    IMAGES.mkdir(parents=True, exist_ok=True)
    policy = policy_files.load(policy_files.shipped("quad")[0])
    parts, found = block_parts(), {}
    for name, usual in TUTORIAL_BLOCKS.items():
        domain = parts[name]
        found[name] = mesh = decomposed(mesh_domain(domain, "quad"), policy, BlockSearch(SECONDS))
        size = float(np.sqrt(domain.area / CELLS))
        walls = (WallLayer(WALLS[name], size / 10.0, 1.3),) if name in WALLS else ()
        grid = block_grid(mesh, Sizing(size=size, walls=walls))
        picture(grid, IMAGES / f"{name.replace(' ', '-')}.png")
        quality = grid.quality
        sys.stdout.write(
            f"| {name} | {usual} | {mesh.n_elements} | {mesh.score} | {mesh.optimum} | "
            f"{grid.cell_count:,} | {quality.worst_scaled_jacobian:.2f} |\n"
        )
        sys.stdout.flush()
    return found


def make_window(mesh: HalfEdgeMesh) -> None:
    """The Blocks view, light and dark, with a chord selected and layers at the cylinder."""
    from stage import SMALL, Stage  # directs the settings of this process to a temporary folder

    from meshwright.desktop.main_window.startup import application

    application()
    mesh = mesh.copy()
    mesh.plan_grid(GridPlan(walls=(Wall("cylinder", 0.01, 1.25),)))
    for theme in ("light", "dark"):
        stage = Stage(mesh.copy(), "cylinder", SMALL, theme)
        blocks = stage.window.blocks
        blocks.show(True)
        blocks.select_edge(int(blocks.planned.structure.patch("cylinder").edges[0]))
        stage.until(lambda job=blocks.job: not job.busy)
        stage.rest(0.4)
        path = IMAGES / f"window-{theme}.png"
        stage.picture().save(path)
        reduce_colours(path)
        stage.close()


def main() -> None:
    """Make all of them."""
    found = make_grids()
    if "--grids" not in sys.argv:
        make_window(found[WINDOW])


if __name__ == "__main__":
    main()
