"""Meshes with straight edges are placed on the curves of a domain."""

import numpy as np
import pytest

from meshwright_core import HalfEdgeMesh, MeshError
from meshwright_core.curves.curve import Curve
from meshwright_core.domains import meshing
from meshwright_core.domains.domain import Domain
from meshwright_core.domains.mesh_on_domain import placed
from meshwright_core.geometry.edge_curves import element_areas

SQUARE = [[-2, -2], [2, -2], [2, 2], [-2, 2]]


def sides(corners) -> list[Curve]:
    return [Curve.line(a, b) for a, b in zip(corners, np.roll(corners, -1, axis=0), strict=True)]


def plate() -> Domain:
    """A square with a round hole."""
    return Domain.from_curves([sides(SQUARE), [Curve.arc((0, 0), 1.0, 0.3, 2 * np.pi)]])


def stadium() -> Domain:
    """Straight sides and half circles: four anchors, no corner."""
    return Domain.from_curves(
        [[
            Curve.line((-1, -1), (1, -1)), Curve.arc((1, 0), 1.0, -np.pi / 2, np.pi),
            Curve.line((1, 1), (-1, 1)), Curve.arc((-1, 0), 1.0, np.pi / 2, np.pi),
        ]]
    )  # fmt: skip


def spoon() -> Domain:
    """Two arcs that meet in corners, and two holes."""
    return Domain.from_curves(
        [
            [Curve.arc_by_bulge((-3, 0), (3, 0), 0.8), Curve.arc_by_bulge((3, 0), (-3, 0), 0.6)],
            [Curve.ellipse((-1, 0), (0.7, 0.2), (-0.1, 0.3), 0.0, 2 * np.pi)],
            [Curve.arc((1.2, 0), 0.6, 0.0, -2 * np.pi)],
        ]
    )


def with_insert() -> Domain:
    """A rectangle of steel, with a half disc of copper at its right side."""
    arc = Curve.arc((2, 0), 1.0, np.pi / 2, np.pi)
    around = sides([[2, 1], [2, 2], [0, 2], [0, -2], [2, -2], [2, -1]])[:-1]
    steel = [[*around, arc.reversed]]
    return Domain.from_regions([("steel", steel), ("copper", [[Curve.line((2, -1), (2, 1)), arc]])])


def chords(domain: Domain, kind: str, **options) -> HalfEdgeMesh:
    """A mesh of the domain's polylines, as a file would hold it."""
    polygon = Domain(domain.outline, domain.holes)
    return meshing.mesh_domain(polygon, kind, **options)


def assert_on_curves(mesh: HalfEdgeMesh, domain: Domain) -> None:
    mesh.validate()
    info = mesh.boundary_info
    rim = np.flatnonzero(mesh.boundary())
    curves = [curve for loop in domain.boundary for curve in loop]
    away = np.min([curve.project(mesh.points[rim, :2])[1] for curve in curves], axis=0)
    assert away.max() < 1e-12 * domain.diameter
    assert info.count == len(domain.boundary) + len(domain.interfaces)
    assert element_areas(mesh).sum() == pytest.approx(domain.area, rel=1e-12)
    assert mesh.optimum == domain.optimum(mesh.kind)


@pytest.mark.parametrize("kind", ["quad", "tri"])
@pytest.mark.parametrize("shape", [plate, stadium, spoon])
def test_boundaries_come_to_lie_on_the_curves(kind, shape):
    domain = shape()
    mesh = chords(domain, kind, max_edge=0.7)
    before = mesh.points.copy()
    on = placed(mesh, domain)
    assert (mesh.points == before).all()
    assert_on_curves(on, domain)
    inner = np.flatnonzero(~mesh.boundary())
    assert (on.points[inner] == mesh.points[inner]).all()
    assert (on.elements() == mesh.elements()).all()
    corners = sum(point.kind == "corner" for point in domain.sides.graph.points.values())
    found = on.geometric().sum()
    assert found == len(domain.sides.graph.points) >= corners


def test_a_coarse_ring_of_chords_is_a_circle_again():
    """Eight vertices of a hole, four of which lie in the middle of chords."""
    quarter = np.array([[1, 0], [0, 1], [-1, 0], [0, -1]], float)
    hole = np.stack([quarter, 0.5 * (quarter + np.roll(quarter, -1, axis=0))], 1).reshape(-1, 2)
    ahead = np.arange(8)
    outer = 2.0 * hole / np.abs(hole).max(axis=1, keepdims=True)
    points = np.vstack([outer, hole])
    quads = np.column_stack([ahead, np.roll(ahead, -1), 8 + np.roll(ahead, -1), 8 + ahead])
    mesh = HalfEdgeMesh.from_elements(points, quads)
    on = placed(mesh, plate())
    assert_on_curves(on, plate())
    assert on.geometric().sum() == 4


def test_regions_and_interfaces_follow_from_the_drawing():
    domain = with_insert()
    angle = np.radians(30.0) * np.arange(7) + np.pi / 2
    way = np.column_stack([np.cos(angle), np.sin(angle)])
    # rings around (2, 0): the last one is cut off by the rectangle but for its corners
    outer = way * np.minimum(2.0 / np.maximum(np.abs(way).max(axis=1), 1e-9), 4.0)[:, None]
    points = np.vstack([[[0.0, 0.0]], 0.5 * way, way, outer]) + [2, 0]
    triangles = []
    for i in range(6):
        triangles.append([0, 1 + i, 2 + i])
        for a, b in ((1 + i, 8 + i), (8 + i, 15 + i)):
            triangles += [[a, b, b + 1], [a, b + 1, a + 1]]
    with pytest.raises(MeshError, match=r"corner \(0, -?2\) of the drawing: the nearest"):
        placed(HalfEdgeMesh.from_elements(points, triangles), domain)
    for corner in ([0, 2], [0, -2]):
        points[np.argmin(np.hypot(*(points - corner).T))] = corner
    on = placed(HalfEdgeMesh.from_elements(points, triangles), domain)
    assert_on_curves(on, domain)
    assert on.region_names == ("steel", "copper")
    areas = np.bincount(on.regions(), element_areas(on))
    assert areas == pytest.approx([region.area for region in domain.regions], rel=1e-12)
    (interface,) = on.interfaces
    ends = {tuple(on.points[v, :2]) for v in (interface.start, interface.end)}
    assert ends == {(2.0, 1.0), (2.0, -1.0)}


def test_what_does_not_fit_is_said_in_one_sentence():
    mesh = chords(plate(), "quad", max_edge=0.7)
    with pytest.raises(MeshError, match="has 2 loops, that of the drawing 1"):
        placed(mesh, Domain.from_curves([sides(SQUARE)]))
    wide = Domain.from_curves([sides(SQUARE), [Curve.arc((0, 0), 1.5, 0.3, 2 * np.pi)]])
    with pytest.raises(
        MeshError, match=r"^Vertex \d+ of the mesh at .* lies 0\.5"
    ):
        placed(mesh, wide)
    high = Domain.from_curves([sides(np.array(SQUARE) * [1, 2]), list(plate().boundary[1])])
    with pytest.raises(MeshError, match=r"at the corner \(-?2, -?4\) .*the nearest one is"):
        placed(mesh, high)
    bent = HalfEdgeMesh.from_elements(mesh.points + [0, 0, 1], mesh.elements())
    with pytest.raises(MeshError, match="does not lie in the plane"):
        placed(bent, plate())


def test_polygons_are_drawings_too():
    polygon = Domain(SQUARE)
    mesh = chords(polygon, "quad", max_edge=0.7)
    on = placed(mesh, polygon)
    assert_on_curves(on, Domain.from_curves([sides(SQUARE)]))
    assert on.geometric().sum() == 4
    assert (on.score, on.optimum) == (mesh.score, mesh.optimum)
