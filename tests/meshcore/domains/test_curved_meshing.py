"""Meshes between curves: coarse, valid, on their curves, of the true area, with s* by formula."""

import math

import numpy as np
import pytest
from curved_domains import BAR, PLATE, SQUARE, circle, lens, ring, turned, two_materials

from meshwright_core import MeshError
from meshwright_core.core.arrays import CURVE
from meshwright_core.core.composite_curves import place_all
from meshwright_core.domains import curved_shapes, gallery, meshing
from meshwright_core.domains.curved_parts import curved_part, curved_suite
from meshwright_core.domains.domain import Domain
from meshwright_core.geometry.edge_curves import element_areas
from meshwright_core.geometry.quality import scaled_jacobian

CURVED = [name for name in gallery.names() if gallery.shape(name).sides is not None]
WAYS = [
    ("tri", {}),
    ("quad", {}),
    ("quad", {"seed": 5}),
    ("quad", {"quads": "pairing"}),
    ("quad", {"max_edge": 0.2}),
    ("tri", {"max_edge": 0.3, "min_angle": 0.0}),
    ("quad", {"max_area": 0.05}),
    ("quad", {"min_angle": 20.0}),
]


def assert_meshes(domain, mesh):
    """The mesh has the topology, area, regions and s* of the domain, and lies on its curves."""
    mesh.validate()
    areas = element_areas(mesh)
    assert areas.sum() == pytest.approx(domain.area, rel=1e-12)
    assert areas.min() > 0
    assert mesh.euler == 2 * domain.outlines - len(domain.loops)
    assert mesh.optimum == domain.optimum(mesh.kind)
    assert mesh.region_names == tuple(region.name for region in domain.regions)
    for number, region in enumerate(domain.regions):
        assert areas[mesh.regions() == number].sum() == pytest.approx(region.area, rel=1e-12)
    rows = np.flatnonzero(mesh.arrays.vertex[: mesh.slots, CURVE] >= 0)
    seats = mesh.arrays.vertex[rows, CURVE].astype(np.int64)
    places = place_all(mesh.boundary_info.curves, seats, mesh.arrays.parameter[rows])
    assert (mesh.points[rows] == places).all()
    points = domain.sides.graph.points.values()
    expected = {tuple(point.place.tolist()) for point in points}
    marked = np.flatnonzero(mesh.geometric())
    assert {tuple(p) for p in mesh.points[marked][:, :2].tolist()} == expected


@pytest.mark.parametrize(("kind", "options"), WAYS)
@pytest.mark.parametrize("name", CURVED)
def test_gallery(name, kind, options):
    domain = gallery.shape(name)
    mesh = meshing.mesh_domain(domain, kind, **options)
    assert_meshes(domain, mesh)
    if "max_edge" in options:
        sides = mesh.points[mesh.elements()] - mesh.points[np.roll(mesh.elements(), 1, axis=1)]
        assert np.linalg.norm(sides, axis=2).max() <= options["max_edge"]


@pytest.mark.parametrize(
    ("name", "quads"),
    [("plate-with-round-hole", 24), ("duct-bend", 24), ("nozzle", 12), ("two-materials", 12),
     ("pipe", 72), ("filleted-bracket", 110), ("airfoil-in-box", 40), ("plate-with-insert", 40)],
)  # fmt: skip
def test_starts_are_coarse(name, quads):
    assert meshing.mesh_domain(gallery.shape(name), "quad").n_elements <= quads


@pytest.mark.parametrize(
    "domain",
    [
        Domain.from_curves([*PLATE, circle(50, 50, 10), circle(200, 0, 5)]),
        Domain.from_curves([circle(0, 0, 1), circle(0.3, 0, 0.5), circle(-0.6, 0, 0.2)]),
        Domain.from_curves([circle(0, 0, 1), circle(0, 0, 0.99)]),
        Domain.from_curves([SQUARE, circle(79, 50, 20)]),
        Domain.from_curves([BAR, circle(60, 20, 19)]),
        Domain.from_regions(two_materials()),
        Domain.from_regions([("plate", PLATE), ("ring", [PLATE[1], circle(50, 50, 15)]),
                             ("core", [turned(circle(50, 50, 15))])]),
        Domain.from_regions([
            ("a", [ring((0, 0), (50, 0), (50, 100), (0, 100))]),
            ("b", [ring((50, 20), (80, 20), (80, 60), (50, 60))]),
        ]),
    ],
    ids=["islands", "eyes", "thin ring", "hole near a wall", "shell", "two", "three", "T"],
)  # fmt: skip
@pytest.mark.parametrize("kind", ["quad", "tri"])
def test_domains(domain, kind):
    assert_meshes(domain, meshing.mesh_domain(domain, kind))


def test_three_regions_around_an_interior_junction():
    hexagon = [(math.cos(a), math.sin(a)) for a in np.radians(60 * np.arange(6))]
    regions = [
        (str(i), [ring((0, 0), *(hexagon[(2 * i + j) % 6] for j in range(3)))]) for i in range(3)
    ]
    domain = Domain.from_regions(regions)
    for kind, degree in (("quad", 3), ("tri", 6)):
        mesh = meshing.mesh_domain(domain, kind)
        assert_meshes(domain, mesh)
        centre = int(np.flatnonzero((mesh.points[: mesh.slots] == 0).all(axis=1))[0])
        assert mesh.desired()[centre] == degree


def test_walls_stay_straight_and_names_are_kept():
    names = [["floor", "bend", "roof", "back"]]
    domain = Domain.from_curves([BAR], names=names)
    info = meshing.mesh_domain(domain, "quad").boundary_info
    (pieces,) = info.pieces
    assert sorted(piece.name for piece in pieces) == sorted(names[0])
    assert {piece.kind for piece in pieces} == {"line", "arc"}
    assert pieces[-1].stop == pytest.approx(info.lengths()[0])
    mesh = meshing.mesh_domain(domain, "quad", max_edge=8.0)
    flat = [p for p in mesh.points[mesh.boundary()[: mesh.slots]] if p[0] < 59.9]
    assert all(p[0] == 0.0 or p[1] in (0.0, 40.0) for p in flat)


def test_interfaces_of_a_mesh():
    mesh = meshing.mesh_domain(gallery.shape("two-materials"), "quad")
    (interface,) = mesh.boundary_info.interfaces
    assert {interface.left, interface.right} == {0, 1}
    ends = mesh.points[[interface.start, interface.end]][:, :2]
    assert sorted(map(tuple, ends.tolist())) == [(0.0, -0.4), (0.0, 0.4)]


def test_sharp_corners_between_arcs():
    domain = Domain.from_curves([lens(20.0)])
    for kind, options in WAYS:
        assert_meshes(domain, meshing.mesh_domain(domain, kind, **options))


def test_bad_arguments_are_refused_as_for_polygons():
    domain = gallery.shape("pipe")
    for arguments in ({"kind": "hex"}, {"kind": "tri", "max_edge": -1.0},
                      {"kind": "tri", "max_edge": 1e-7}, {"kind": "tri", "min_angle": 50.0},
                      {"kind": "quad", "quads": "paving"}):  # fmt: skip
        with pytest.raises(MeshError):
            meshing.mesh_domain(domain, **arguments)


@pytest.mark.slow
def test_suite_of_curved_parts_is_reproducible_and_varied():
    domains = curved_suite(0)
    assert len(domains) == 34
    kinds = {curve.kind for domain in domains for loop in domain.boundary for curve in loop}
    assert kinds == {"line", "arc", "ellipse", "spline"}
    assert {len(domain.holes) for domain in domains} >= {0, 1, 2, 3, 4, 5}
    again = curved_suite(0)
    assert [a.to_json() for a in domains] == [b.to_json() for b in again]
    for domain in domains[::6]:
        mesh = meshing.mesh_domain(domain, "quad")
        assert_meshes(domain, mesh)
        assert mesh.n_elements < 300


def test_a_point_of_a_flat_triangle_is_not_inserted_twice():
    part = curved_part(np.random.default_rng([555002]))
    mesh = meshing.mesh_domain(part, "quad")
    mesh.validate()
    assert mesh.optimum == part.optimum("quad")
    assert element_areas(mesh).sum() == pytest.approx(part.area, rel=1e-12)


@pytest.mark.parametrize("rows", [(10, 20), (10, 20, 30, 40, 50)])
def test_no_slivers_along_a_row_of_small_holes(rows):
    holes = [circle(10 + 10 * i, y, 3) for i in range(40) for y in rows]
    domain = Domain.from_curves([ring((0, 0), (410, 0), (410, 60), (0, 60)), *holes])
    mesh = meshing.mesh_domain(domain, "quad")
    assert_meshes(domain, mesh)
    assert scaled_jacobian(mesh).min() > 0.05
    assert mesh.n_elements < 24 * len(holes)


def test_no_element_is_inverted_beside_a_ring_of_holes_along_an_arc():
    around = np.linspace(0.0, 2 * math.pi, 60, endpoint=False)
    holes = [circle(85 * math.cos(a), 85 * math.sin(a), 3) for a in around]
    domain = Domain.from_curves([circle(0, 0, 100), *holes])
    mesh = meshing.mesh_domain(domain, "quad")
    assert_meshes(domain, mesh)
    assert scaled_jacobian(mesh).min() > 0


def test_long_thin_regions_are_not_cut_along_their_walls():
    layers = [(name, [ring((0, y), (1000, y), (1000, y + 2), (0, y + 2))])
              for name, y in (("steel", 0), ("copper", 2), ("glass", 4))]  # fmt: skip
    domain = Domain.from_regions(layers)
    assert meshing.mesh_domain(domain, "quad").n_elements <= 3 * 6


def test_flattened_domain_has_the_corners():
    domain = gallery.shape("filleted-bracket")
    flat = domain.flattened(15.0)
    assert flat.sides is None
    assert sum(flags.sum() for flags in flat.loop_corners) == 0
    assert flat.area == pytest.approx(domain.area, rel=5e-3)
    with pytest.raises(MeshError, match="no polygon"):
        curved_shapes.two_materials().flattened(15.0)
