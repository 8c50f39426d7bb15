"""Makes the pictures of the block grids of five tutorial cases, into docs/images/blocks.

    python docs/make_block_pictures.py

Each case is meshed, searched for ten seconds and divided; the picture shows the cells, and the
edges of blocks thick. It prints the number of blocks beside that of the usual hand-made grid.
"""

import sys
from pathlib import Path

import matplotlib
import numpy as np
from matplotlib import pyplot
from matplotlib.collections import LineCollection

from meshwright.assistant.block_search import BlockSearch, decomposed
from meshwright_agent.policy import policy_files
from meshwright_core.blocks.grid import BlockGrid, Sizing, WallLayer, block_grid
from meshwright_core.domains.block_parts import TUTORIAL_BLOCKS, block_parts
from meshwright_core.domains.meshing import mesh_domain

IMAGES = Path(__file__).parent / "images" / "blocks"
SECONDS = 10.0
CELLS = 1200
WALLS = {"cylinder in a channel": "cylinder", "airfoil with a wake": "wing"}


def picture(grid: BlockGrid, path: Path) -> None:
    """Write the picture of a grid."""
    matplotlib.use("Agg")
    points = grid.points[:, :2]
    lines, edges = [], []
    for block in range(len(grid.shapes)):
        at = points[grid.block_vertices(block)]
        lines += [*at, *at.swapaxes(0, 1)]
    for edge in range(len(grid.structure.edges)):
        edges.append(points[grid.edge_vertices(edge)])
    figure, axes = pyplot.subplots(figsize=(8, 5), dpi=110)
    axes.add_collection(LineCollection(lines, colors="#8aa0b8", linewidths=0.4))
    axes.add_collection(LineCollection(edges, colors="#0b3d6e", linewidths=1.6))
    axes.set_aspect("equal")
    axes.autoscale()
    axes.axis("off")
    figure.tight_layout(pad=0.2)
    figure.savefig(path)
    pyplot.close(figure)


def main() -> None:
    """Make all five."""
    IMAGES.mkdir(parents=True, exist_ok=True)
    policy = policy_files.load(policy_files.shipped("quad")[0])
    parts = block_parts()
    for name, usual in TUTORIAL_BLOCKS.items():
        domain = parts[name]
        mesh = decomposed(mesh_domain(domain, "quad"), policy, BlockSearch(SECONDS))
        size = float(np.sqrt(domain.area / CELLS))
        walls = (WallLayer(WALLS[name], size / 10.0, 1.3),) if name in WALLS else ()
        grid = block_grid(mesh, Sizing(size=size, walls=walls))
        picture(grid, IMAGES / f"{name.replace(' ', '-')}.png")
        worst = grid.quality.worst_scaled_jacobian
        sys.stdout.write(
            f"{name}: {mesh.n_elements} blocks (usual {usual}), s {mesh.score}, "
            f"s* {mesh.optimum}, worst scaled Jacobian {worst:.2f}\n"
        )
        sys.stdout.flush()


if __name__ == "__main__":
    main()
