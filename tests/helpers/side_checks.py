"""What holds for boundary vertices whatever moves them."""

import numpy as np

from meshwright_core.geometry.sides import Sides


def assert_on_sides(mesh):
    """Boundary vertices lie on their sides to 1e-12, and in their order."""
    sides = Sides(mesh)
    for number, chain in enumerate(sides.chains):
        for v in chain.tolist():
            if v in sides:
                point, _ = sides.project(v, mesh.points[v])
                assert np.abs(point - mesh.points[v]).max() < 1e-12
        here = [sides.project(v, mesh.points[v])[1] for v in chain.tolist() if v in sides]
        back = np.count_nonzero(np.diff(here) <= 0)
        assert back <= (1 if sides.polylines.closed[number] else 0)
