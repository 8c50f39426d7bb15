"""What holds for vertices on curves whatever moves them."""

import numpy as np

from meshwright_core.core.composite_curves import place_all


def assert_on_sides(mesh):
    """Vertices on curves lie at their parameters to the bit, and these are in order."""
    curve, t = mesh.curve_ids(), mesh.parameters()
    on = np.flatnonzero(curve >= 0)
    there = place_all(mesh.boundary_info.curves, curve[on].astype(np.int64), t[on])
    size = np.ptp(mesh.points, axis=0).max()
    slides = ~mesh.geometric()[on] & ~mesh.locked()[on]
    assert np.abs(there - mesh.points[on]).max(initial=0.0) < 1e-12 * size
    off = (there != mesh.points[on]).any(axis=1) & slides
    assert np.abs(there - mesh.points[on])[off].max(initial=0.0) < 2e-13 * size
    mesh.validate()
