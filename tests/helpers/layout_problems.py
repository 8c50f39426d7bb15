"""The problem that positions of a layout are found by, and a mesh whose sides bend."""

import numpy as np

from meshwright_core.curves.curve import Curve
from meshwright_core.domains.domain import Domain
from meshwright_core.domains.meshing import mesh_domain
from meshwright_core.geometry import layout_positions as positions
from meshwright_core.geometry.bent_elements import (
    COUNT,
    PLACES,
    QUARTERS,
    BentElements,
    find_bent,
)
from meshwright_core.geometry.worst_corner import LayoutProblem


def problem_of(mesh):
    rails = positions.rails_of(mesh, len(mesh.arrays.vertex))
    *fields, x, elements = positions.assemble(mesh.arrays, rails, False, np.zeros(0, np.bool_))
    variable = LayoutProblem._fields.index("variable")
    rows, *sides = find_bent(mesh.arrays, rails.turning, fields[variable], x, elements)
    scale = fields[-1][4 * rows]
    b = len(rows)
    bent = BentElements(
        QUARTERS, np.array([COUNT]), *sides, scale, np.zeros((b, 4, PLACES, 6)),
        np.zeros((b, COUNT, 4)),
        np.zeros((b, COUNT, 4)), np.zeros((b, 4, 2)),
    )  # fmt: skip
    return LayoutProblem(*fields, bent, mesh.arrays.curves), x.copy()


def round_hole():
    square = [Curve.line(a, b) for a, b in (
        ((0, 0), (3, 0)), ((3, 0), (3, 2)), ((3, 2), (0, 2)), ((0, 2), (0, 0)),
    )]  # fmt: skip
    domain = Domain.from_curves([square, [Curve.arc((1.4, 1.0), 0.4, 0.3, 2 * np.pi)]])
    return mesh_domain(domain, "quad")
