"""s* where several regions meet: against counting, by hand, and kept by operations."""

from __future__ import annotations

import itertools
import json
import math

import numpy as np
import pytest
from numpy.random import default_rng
from scipy.optimize import Bounds, LinearConstraint, milp

from meshwright_core import HalfEdgeMesh, MeshError
from meshwright_core.core.arrays import DELTA_SUM
from meshwright_core.core.irregularity import desired_between
from meshwright_core.core.score_bound import (
    Passages,
    SharedVertices,
    bound_excess,
    bound_excess_of,
    slack_of,
)
from meshwright_core.curves.curve import Curve
from meshwright_core.domains.block_parts import PARTS
from meshwright_core.domains.curved_shapes import box, polygon
from meshwright_core.domains.domain import Domain
from meshwright_core.domains.mesh_on_domain import placed
from meshwright_core.domains.meshing import mesh_domain
from meshwright_core.io import snapshot

NONE = Passages(*(np.zeros(0, np.int64) for _ in range(3)))


def around(count: int, radius: float = 0.4) -> np.ndarray:
    """(n, 2) corners of a regular polygon."""
    angle = 2.0 * np.pi * np.arange(count) / count
    return radius * np.column_stack([np.cos(angle), np.sin(angle)])


def inlaid(count: int, corner_angle: float = 0.01) -> Domain:
    """A regular polygon in a square plate."""
    loop = polygon(around(count).tolist())
    return Domain.from_regions(
        [("plate", [box(-1, -1, 1, 1), loop]), ("inlay", [loop])], corner_angle=corner_angle
    )


def ring_sector(inner: float, outer: float, sweep: float) -> list[Curve]:
    """Loop of a sector of a ring, from angle 0."""
    a, b = np.array([1.0, 0.0]), np.array([math.cos(sweep), math.sin(sweep)])
    return [
        Curve.line(inner * a, outer * a),
        Curve.arc((0, 0), outer, 0.0, sweep),
        Curve.line(outer * b, inner * b),
        Curve.arc((0, 0), inner, sweep, -sweep),
    ]


def motor(sweep: float) -> Domain:
    """A segment of a motor: rotor, gap and stator."""
    radii = [("rotor", 0.5, 1.0), ("gap", 1.0, 1.1), ("stator", 1.1, 2.0)]
    return Domain.from_regions([(name, [ring_sector(a, b, sweep)]) for name, a, b in radii])


def junction(slope: float) -> Domain:
    """Three regions that meet in a point: one over the whole height, two beside it."""
    middle, end = (1.0, 1.0), (2.0, 1.0 + slope)
    return Domain.from_regions(
        [
            ("left", [polygon([(0, 0), (1, 0), middle, (1, 2), (0, 2)])]),
            ("below", [polygon([(1, 0), (2, 0), end, middle])]),
            ("above", [polygon([middle, end, (2, 2), (1, 2)])]),
        ]
    )


DOMAINS = {
    "two layers": PARTS["two layers"](),
    "inlay": PARTS["inlay"](),
    **{f"inlay of {count} corners": inlaid(count) for count in (3, 4, 5, 6, 8, 12)},
    "motor 90": motor(math.pi / 2),
    "motor 140": motor(math.radians(140)),
    "junction": junction(0.0),
    "slanted junction": junction(0.9),
    "steep junction": junction(-0.8),
}


def counted(domain: Domain, k: int, more: int = 10) -> int:
    """The lowest s by an integer programme over the numbers of elements in all sectors.

    The vertices are the domain's geometric points and `more` on each interface, smooth there.
    """
    assert domain.sides is not None
    usual, weight = (2, 4) if k == 4 else (3, 6)
    regions = domain.regions
    vertices = [
        (desired_between([a for _, a in point.sectors], k, point.boundary), point.boundary,
         list(point.sectors))
        for point in domain.sides.graph.points.values()
    ]  # fmt: skip
    for side in domain.sides.all_sides[len(domain.sides.loop_sides) :]:
        first = side.pieces[0]
        vertices += [(2 * usual, False, [(first.left, 180.0), (first.right, 180.0)])] * more
    sectors = [(v, r, a) for v, (_, _, around) in enumerate(vertices) for r, a in around]
    # variables: n of each sector, sum inside each region, |Delta| of each vertex, |sum| of each
    n, r, v = len(sectors), len(regions), len(vertices)
    rows, low, high = [], [], []

    def require(entries: dict[int, float], least: float, most: float) -> None:
        row = np.zeros(n + 2 * r + v)
        for column, value in entries.items():
            row[column] += value
        rows.append(row)
        low.append(least)
        high.append(most)

    for number, region in enumerate(regions):
        mine = [i for i, (_, one, _) in enumerate(sectors) if one == number]
        total = -weight * (1 - region.holes) + usual * len(mine)
        require({**dict.fromkeys(mine, 1.0), n + number: 1.0}, total, total)
        for sign in (1.0, -1.0):
            require({n + number: -sign, n + r + v + number: 1.0}, 0.0, np.inf)
    for number, (desired, boundary, _) in enumerate(vertices):
        mine = [i for i, (one, _, _) in enumerate(sectors) if one == number]
        for sign in (1.0, -1.0):
            entries = {**dict.fromkeys(mine, -sign), n + r + number: 1.0}
            require(entries, -sign * (desired - boundary), np.inf)
    least = np.full(n + 2 * r + v, -np.inf)
    least[:n] = [max(1, math.floor(angle / 180.0 + 1e-6) + 1) for _, _, angle in sectors]
    cost = np.concatenate([np.zeros(n + r), np.ones(v + r)])
    found = milp(
        cost, constraints=LinearConstraint(np.array(rows), low, high), bounds=Bounds(least, np.inf),
        integrality=np.append(np.ones(n + r), np.zeros(v + r)),
    )  # fmt: skip
    assert found.status == 0
    return round(found.fun)


@pytest.mark.parametrize("kind", ["tri", "quad"])
@pytest.mark.parametrize("name", DOMAINS)
def test_the_bound_is_that_of_an_integer_programme(name, kind):
    domain = DOMAINS[name]
    assert domain.optimum(kind) == counted(domain, 3 if kind == "tri" else 4)


@pytest.mark.parametrize("kind", ["tri", "quad"])
@pytest.mark.parametrize("name", DOMAINS)
def test_meshes_have_the_bound_of_their_domain(name, kind):
    domain = DOMAINS[name]
    mesh = mesh_domain(domain, kind)
    assert mesh.optimum == domain.optimum(kind)
    assert (mesh.score - mesh.optimum) % 2 == 0
    assert mesh.score >= mesh.optimum


@pytest.mark.parametrize(
    ("name", "lowest", "total"),
    [
        ("two layers", 0, 0),
        ("inlay", 8, 0),  # four inside the disc, four around it
        ("inlay of 3 corners", 2, 0),
        ("inlay of 4 corners", 0, 0),
        ("inlay of 6 corners", 0, 0),  # two corners have two quads on either side
        ("inlay of 8 corners", 8, 8),
        ("motor 90", 0, 0),
        ("junction", 0, 0),
    ],
)
def test_bounds_of_quads_by_hand(name, lowest, total):
    mesh = mesh_domain(DOMAINS[name], "quad")
    assert (mesh.optimum, abs(int(mesh.arrays.counters[DELTA_SUM]))) == (lowest, total)


@pytest.mark.parametrize("name", DOMAINS)
def test_triangles_of_connected_regions_cancel_freely(name):
    mesh = mesh_domain(DOMAINS[name], "tri")
    assert mesh.optimum == abs(int(mesh.arrays.counters[DELTA_SUM]))


def test_kinks_of_a_polyline_may_be_used():
    smooth = inlaid(24, corner_angle=30.0)
    assert smooth.optimum("quad") == 0
    assert mesh_domain(smooth, "quad").optimum == 0
    assert inlaid(24).optimum("quad") == mesh_domain(inlaid(24), "quad").optimum


@pytest.mark.parametrize("seed", range(60))
def test_flows_against_all_numbers(seed):
    rng = default_rng(seed)
    regions = int(rng.integers(2, 4))
    balance = rng.integers(-2, 3, regions)
    surplus = rng.integers(-1, 2, 2)
    sectors = [(v, int(r)) for v in (0, 1) for r in rng.choice(regions, 2, replace=False)]
    slack = rng.integers(0, 3, len(sectors))
    shared = SharedVertices(surplus, *(np.array(c) for c in zip(*sectors, strict=True)), slack)
    lowest = np.inf
    for change in itertools.product(*(range(-least, 5) for least in slack.tolist())):
        inside = balance.copy()
        delta = -surplus.copy()
        for (v, r), one in zip(sectors, change, strict=True):
            inside[r] -= one
            delta[v] += one
        lowest = min(lowest, np.abs(inside).sum() + np.abs(delta).sum())
    total = abs(int(balance.sum() - surplus.sum()))
    assert total + bound_excess(balance, shared, NONE) == lowest


def test_slack_of_sectors():
    angle = np.array([90.0, 134.0, 136.0, 179.0, 180.0 - 1e-5, 180.0, 224.0, 226.0, 320.0, 360.0])
    share = np.array([1, 1, 2, 2, 2, 2, 2, 3, 4, 4])
    assert slack_of(angle, share).tolist() == [0, 0, 1, 1, 0, 0, 0, 1, 2, 1]


def test_an_inlay_is_meshed_at_its_bound():
    core, ring = around(4, 0.2), around(4, 0.4)
    points = np.vstack([core, ring, [(1, 0), (0, 1), (-1, 0), (0, -1)]])
    turned = np.array([[math.cos(0.25 * math.pi), -math.sin(0.25 * math.pi)],
                       [math.sin(0.25 * math.pi), math.cos(0.25 * math.pi)]])  # fmt: skip
    points[:8] = points[:8] @ turned.T
    points[8:] = np.array([(1, 1), (-1, 1), (-1, -1), (1, -1)])
    elements = [[0, 1, 2, 3]]
    for inner in (0, 4):
        for i in range(4):
            j = (i + 1) % 4
            elements.append([inner + i, inner + 4 + i, inner + 4 + j, inner + j])
    regions = [1] * 5 + [0] * 4
    mesh = placed(HalfEdgeMesh.from_elements(points, elements, regions=regions), DOMAINS["inlay"])
    assert (mesh.score, mesh.optimum) == (8, 8)


def test_desired_degrees_change_the_bound_and_undo_restores_it():
    mesh = mesh_domain(DOMAINS["inlay"], "quad")
    parts = mesh.regions()
    inside = [int(e) for e in mesh.element_ids()[parts == parts[-1]]]
    corners = mesh.corners(np.array(inside)).ravel()
    free = [int(v) for v in np.unique(corners) if mesh.curve_ids()[v] < 0]
    mesh.set_desired(free[0], 3)
    assert mesh.optimum == bound_excess_of(mesh.arrays) + abs(mesh.arrays.counters[DELTA_SUM])
    sign = 1 if mesh.optimum > 8 else -1
    assert mesh.optimum == 8 + sign
    mesh.undo()
    assert mesh.optimum == 8
    mesh.redo()
    assert mesh.optimum == 8 + sign
    assert mesh.copy(history=True).optimum == 8 + sign


def test_marks_and_compacting_keep_the_bound():
    mesh = mesh_domain(DOMAINS["inlay"], "quad")
    interface = mesh.interfaces[0].curve
    on_it = [int(v) for v in mesh.vertices() if mesh.curve_ids()[v] == interface]
    mesh.set_geometric(on_it[0], not mesh.geometric()[on_it[0]])
    assert mesh.optimum == 8 == bound_excess_of(mesh.arrays)
    mesh.compact()
    assert mesh.optimum == 8 == bound_excess_of(mesh.arrays)


def test_random_operations_keep_the_bound():
    mesh = mesh_domain(DOMAINS["inlay"], "quad")
    rng, done = default_rng(3), 0
    while done < 150:
        h = int(rng.integers(4 * len(mesh.element_ids())))
        name = str(rng.choice(["flip_left", "flip_right", "split", "collapse", "global_split"]))
        if mesh.live(h) and mesh.check(name, h):
            mesh.apply(name, h)
            done += 1
        if done % 50 == 0:
            assert bound_excess_of(mesh.arrays) == 8
    assert mesh.optimum == 8


def test_files_keep_the_bound():
    mesh = mesh_domain(DOMAINS["inlay"], "quad")
    mesh.set_desired(int(mesh.vertices()[-1]), 3)
    again = snapshot.from_arrays(snapshot.to_arrays(mesh))
    assert again.optimum == mesh.optimum
    again.undo()
    assert again.optimum == 8


def test_files_from_before_keep_their_bound_until_it_is_renewed():
    arrays = snapshot.to_arrays(mesh_domain(DOMAINS["inlay"], "quad"))
    record = json.loads(arrays["boundary"].tobytes())
    assert record.pop("bound excess") == 8
    arrays["boundary"] = np.frombuffer(json.dumps(record).encode(), np.uint8)
    old = snapshot.from_arrays(arrays)
    assert old.optimum == 0
    old.renew_bound()
    assert old.optimum == 8
    record["bound excess"] = 6
    arrays["boundary"] = np.frombuffer(json.dumps(record).encode(), np.uint8)
    with pytest.raises(MeshError, match="lower bound"):
        snapshot.from_arrays(arrays)
