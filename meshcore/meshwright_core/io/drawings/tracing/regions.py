"""Traces regions: the curves of a drawing are joined, and what they enclose is told apart.

What is material follows from the drawing. Areas that the file states are it, or all that is
enclosed and not marked as a hole (Triangle's files). Else loops inside one another are outlines and
holes by turns (even-odd), parts of a loop that a curve divides are regions side by side, and a loop
that is drawn on two layers, once as a hole and once as an outline, separates two regions.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Sequence

import numpy as np
import shapely
from numpy.typing import NDArray

from meshwright_core.core.irregularity import CORNER_ANGLE
from meshwright_core.core.time_limit import check_time
from meshwright_core.curves.curve import Curve
from meshwright_core.domains.loops.near_pairs import pairs_near
from meshwright_core.errors import MeshError
from meshwright_core.io.drawings.drawn import Drawing, Points, counted, listed, place_words
from meshwright_core.io.drawings.report import DrawingReport, FoundRegion, Side
from meshwright_core.io.drawings.tracing import loose_ends, measures
from meshwright_core.io.drawings.tracing.crossings import crossings, split_at_crossings
from meshwright_core.io.drawings.tracing.faces import Face, Faces, Way, around, faces_of
from meshwright_core.io.drawings.tracing.gaps import Repair, mended
from meshwright_core.io.drawings.tracing.mending_words import mending_words
from meshwright_core.io.drawings.tracing.network import Edge, Network, joined
from meshwright_core.io.drawings.tracing.region_names import named

TOLERANCE = 1e-5
"""Ends nearer than this share of the drawing's size are one point."""
GAP = 1e-3
"""Gaps at loose ends up to this share of the drawing's size are closed."""
SMOOTH = 1.0
"""Degrees that two curves may turn where they meet without a corner: files round their numbers."""
MAX_REGIONS = 10_000
_SAME = 1e-9
"""Points of a polyline nearer than this share of the drawing's size are one point twice."""


def traced(
    drawing: Drawing,
    corner_angle: float = CORNER_ANGLE,
    gap: float | None = None,
    layers: Collection[str] | None = None,
) -> DrawingReport:
    """Return the regions of a drawing, whose curves may have any order and direction.

    Args:
        drawing: what was read.
        corner_angle: degrees by which the boundary turns at a corner; 1 degree at least where a
            curve is involved.
        gap: width of gaps that are closed, in the units of the drawing; None: 0.001 of its size.
        layers: of the curves that count; None: all.

    Raises:
        MeshError: there is nothing, or nothing closed; too many points, curves or regions.
    """
    return _Tracer(drawing, corner_angle, gap, layers).report()


class _Tracer:
    """One drawing on its way to regions."""

    def __init__(
        self,
        drawing: Drawing,
        corner_angle: float,
        gap: float | None,
        layers: Collection[str] | None,
    ) -> None:
        self.drawing = drawing
        self.corner_angle = corner_angle
        self.drawn = drawing.curves
        if layers is not None:
            wanted = {layer.lower() for layer in layers}
            self.drawn = [one for one in drawing.curves if (one.layer or "0").lower() in wanted]
            if not self.drawn:
                there = listed(sorted({one.layer or "0" for one in drawing.curves}))
                raise MeshError(
                    f"there is nothing on the layer {listed(sorted(layers))}, but on {there}"
                )
        if not self.drawn:
            raise MeshError("there are no lines or curves in it")
        boxes = np.array([one.curve.box for one in self.drawn])
        if not np.isfinite(boxes).all():
            raise MeshError("a coordinate is not a finite number")
        self.size = float((boxes[:, 1].max(axis=0) - boxes[:, 0].min(axis=0)).max())
        self.tolerance = TOLERANCE * self.size
        self.gap = GAP * self.size if gap is None else gap
        self.repairs = list(drawing.notes)

    def report(self) -> DrawingReport:
        """Trace the drawing."""
        network, mends = self._network()
        faces = faces_of(network)
        if not faces.faces and (network.degrees() == 1).any():
            faces, network = self._crossed(faces, network)
        material = self._material(faces)
        regions = self._regions(faces, material, network)
        kept = {i for face in faces.faces for i, _ in face.ways}
        used = {owner for i in kept for owner in network.edges[i].owners}
        strays = [one for i, one in enumerate(self.drawn) if i not in used]
        opened = loose_ends.opened(
            network, faces.stray, max((region.area for region in regions), default=0.0), self.size
        )
        if not regions:
            raise MeshError(self._nothing(opened, network))
        between = {
            i
            for i, sides in self._sides(faces).items()
            if all(f >= 0 and material[f] for f in sides)
        }
        self.repairs += mending_words(mends, network, kept, between, self.size, self.tolerance)
        ignored = [f"{count:,} {kind}" for kind, count in sorted(self.drawing.ignored.items())]
        told = [f"{', '.join(ignored)} left out"] if ignored else []
        if strays:
            place = place_words(strays[0].curve.start)
            number = counted(len(strays), "line or curve", "lines and curves")
            verb = "encloses" if len(strays) == 1 else "enclose"
            told.append(f"{number} that {verb} nothing left out, the first at {place}")
        return DrawingReport(
            regions,
            self.repairs,
            told,
            [sentence for sentence, _ in opened],
            next((sentence for sentence, is_serious in opened if is_serious), ""),
            self.drawing.units,
        )

    def _nothing(self, opened: list[tuple[str, bool]], network: Network) -> str:
        """Why there is no region."""
        told = f"; {self.drawing.notes[0]}" if self.drawing.notes else ""
        if opened:
            return opened[0][0] + told
        for crossing in crossings(network.edges, network.nodes, self.tolerance, self.size):
            verb = "touches" if crossing.touches else "crosses"
            return f"the outline {verb} itself at {place_words(crossing.place)}"
        return f"there is no closed outline in it{told}"

    def _network(self) -> tuple[Network, list[Repair]]:
        curves = [self._without_repeats(one.curve) for one in self.drawn]
        network = joined(curves, [(i,) for i in range(len(curves))], self.tolerance)
        network, mends = mended(network, self.gap, self.tolerance)
        return self._without_slivers(network), mends

    def _without_repeats(self, curve: Curve) -> Curve:
        """A polyline without points that all but repeat the one before."""
        if curve.kind != "polyline":
            return curve
        points = curve.data["points"]
        apart = np.hypot(*np.diff(points, axis=0).T) > _SAME * self.size
        if apart.all():
            return curve
        keep = np.concatenate([[True], apart])
        # its ends stay
        keep[-1] = True
        if keep.sum() > 2 and not apart[-1]:
            keep[np.flatnonzero(keep[:-1])[-1]] = False
            keep[0] = True
        return Curve.polyline(points[keep]) if keep.sum() > 1 else curve

    def _without_slivers(self, network: Network) -> Network:
        """Drop one of two curves that enclose less than the tolerance between them."""
        dropped: dict[int, int] = {}
        for face in faces_of(network).faces:
            if len(face.ways) != 2 or face.ways[0][0] == face.ways[1][0]:
                continue
            check_time()
            (i, _), (j, _) = face.ways
            length = network.edges[i].curve.length
            if face.area <= 2 * self.tolerance * length and i not in dropped and j not in dropped:
                # the one that is straight is the poorer one
                if network.edges[i].curve.kind in ("line", "polyline"):
                    i, j = j, i
                dropped[j] = i
        if not dropped:
            return network
        edges = list(network.edges)
        for j, i in dropped.items():
            own = tuple(dict.fromkeys(edges[i].owners + edges[j].owners))
            edges[i] = Edge(edges[i].a, edges[i].b, edges[i].curve, own)
        edges = [edge for i, edge in enumerate(edges) if i not in dropped]
        return Network(network.nodes, edges, network.hairs, network.moved)

    def _crossed(self, faces: Faces, network: Network) -> tuple[Faces, Network]:
        """Split lines that cross where nothing is closed otherwise: ends drawn too far."""
        split = split_at_crossings(network, self.tolerance, self.size)
        if len(split.edges) == len(network.edges):
            return faces, network
        found = faces_of(split)
        if not found.faces:
            return faces, network
        self.repairs.append("nothing was closed: lines and curves were split where they cross")
        return found, split

    def _material(self, faces: Faces) -> list[bool]:
        """Whether each face is material."""
        if len(faces.faces) > MAX_REGIONS:
            raise MeshError(
                f"it has {len(faces.faces):,} loops, and {MAX_REGIONS:,} are the most that are read"
            )
        self.parent = around(faces)
        self.children: dict[int, list[int]] = {}
        for island, parent in enumerate(self.parent.tolist()):
            self.children.setdefault(parent, []).append(island)
        self.inside = self._inner_points(faces)
        if self.drawing.areas is not None:
            return [i >= 0 for i in self._area_of(faces).tolist()]
        material = [False] * len(faces.faces)
        if self.drawing.holes is not None:
            shapes = self._shapes
            spots = shapely.points(self.drawing.holes)
            void = set(pairs_near(spots, "within", others=shapes)[1].tolist())
            return [i not in void for i in range(len(faces.faces))]
        order = sorted(range(len(faces.islands)), key=lambda i: -faces.islands[i].area)
        for island in order:
            parent = int(self.parent[island])
            solid = parent < 0 or not material[parent] or self._is_insert(faces, island)
            for i in faces.islands[island].faces:
                material[i] = solid
        return material

    def _is_insert(self, faces: Faces, island: int) -> bool:
        """Whether the rim is drawn on two layers: as the hole of one region, and as an outline."""
        check_time()
        for i, _ in faces.islands[island].rim:
            if len({self.drawn[owner].layer for owner in faces.edges[i].owners}) < 2:
                return False
        return True

    def _inner_points(self, faces: Faces) -> Points:
        """A point in each face, outside of the islands in it."""
        if not faces.faces:
            self._shapes = np.zeros(0, object)
            return np.zeros((0, 2))
        self._shapes = faces.polygons.copy()
        for i, islands in self.children.items():
            if i >= 0:
                holes = [faces.outline(faces.islands[island].rim) for island in islands]
                self._shapes[i] = shapely.Polygon(faces.outline(faces.faces[i].ways), holes)
        found: Points = shapely.get_coordinates(shapely.point_on_surface(self._shapes))
        return found

    def _area_of(self, faces: Faces) -> NDArray[np.int64]:
        """The smallest stated area that each face belongs to; -1 for none."""
        found = np.full(len(faces.faces), -1)
        shapes = []
        for area in self.drawing.areas or []:
            check_time()
            rings = [
                np.concatenate([measures.samples(c)[:-1] for c in ring]) for ring in area.rings
            ]
            # even-odd, whichever ring comes first
            shape = shapely.Polygon()
            for ring in rings:
                if len(ring) >= 3:
                    shape = shape.symmetric_difference(shapely.Polygon(ring).buffer(0))
            shapes.append(shape)
        sizes = shapely.area(np.array(shapes))
        spots = shapely.points(self.inside)
        face, area_index = pairs_near(spots, "within", others=shapes)
        for i, j in zip(face.tolist(), area_index.tolist(), strict=True):
            if found[i] < 0 or sizes[j] < sizes[found[i]]:
                found[i] = j
        return found

    def _regions(
        self, faces: Faces, material: Sequence[bool], network: Network
    ) -> list[FoundRegion]:
        solid = [i for i in range(len(faces.faces)) if material[i]]
        area = {i: self._area(faces, faces.faces[i], i) for i in solid}
        solid.sort(key=lambda i: -area[i])
        number = {face: i for i, face in enumerate(solid)}
        side = self._sides(faces)
        touches: list[set[int]] = [set() for _ in solid]
        for left, right in side.values():
            if left in number and right in number and left != right:
                touches[number[left]].add(number[right])
                touches[number[right]].add(number[left])
        ways = [self._loops(faces, i) for i in solid]
        names, layers = self._names(faces, solid, ways)
        crossing = self._crossings(faces, ways, network)
        for k, place in self._pinches(faces, material, ways, network).items():
            crossing[k] = crossing[k] or f"the boundary touches itself at {place_words(place)}"
        regions = []
        for k, i in enumerate(solid):
            check_time()
            loops = tuple(
                tuple(
                    Side(faces.edges[e].curve, back, self._name(faces.edges[e])) for e, back in loop
                )
                for loop in ways[k]
            )
            holes = sum(
                not any(material[j] for j in faces.islands[island].faces)
                for island in self.children.get(i, [])
            )
            regions.append(
                FoundRegion(
                    names[k], area[i], holes, sum(map(self._corners, loops)), layers[k], loops,
                    self.inside[i], tuple(sorted(touches[k])), crossing[k],
                )
            )  # fmt: skip
        return regions

    def _area(self, faces: Faces, face: Face, index: int) -> float:
        return face.area - sum(
            faces.islands[island].area for island in self.children.get(index, [])
        )

    def _loops(self, faces: Faces, index: int) -> list[list[Way]]:
        inner = [faces.islands[island].rim for island in self.children.get(index, [])]
        return [faces.faces[index].ways, *inner]

    def _sides(self, faces: Faces) -> dict[int, tuple[int, int]]:
        """The faces on the left and on the right of each edge; -1 outside of all."""
        side: dict[int, list[int]] = {}
        for i, face in enumerate(faces.faces):
            for edge, back in face.ways:
                side.setdefault(edge, [-1, -1])[int(back)] = i
        for island, parent in enumerate(self.parent.tolist()):
            for edge, back in faces.islands[island].rim:
                side.setdefault(edge, [-1, -1])[int(back)] = parent
        return {edge: (left, right) for edge, (left, right) in side.items()}

    def _names(
        self, faces: Faces, solid: list[int], ways: list[list[list[Way]]]
    ) -> tuple[list[str], list[str]]:
        """Name and layer of each region."""
        given = [""] * len(solid)
        layers: list[set[str]] = []
        areas = self.drawing.areas
        of = self._area_of(faces) if areas is not None else None
        for k, i in enumerate(solid):
            common: set[str] | None = None
            for edge, _ in ways[k][0]:
                own = {self.drawn[owner].layer for owner in faces.edges[edge].owners}
                common = own if common is None else common & own
            layers.append(common or set())
            if areas is not None and of is not None and of[i] >= 0:
                given[k] = areas[of[i]].name
                layers[k] = {areas[of[i]].layer}
        if self.drawing.labels and solid:
            shapes = self._shapes[solid]
            spots = shapely.points(np.array([place for _, place in self.drawing.labels]))
            label, region = pairs_near(spots, "within", others=shapes)
            for j, k in zip(label.tolist(), region.tolist(), strict=True):
                given[k] = given[k] or self.drawing.labels[j][0]
        return named(given, layers)

    def _name(self, edge: Edge) -> str:
        return next((n for owner in edge.owners if (n := self.drawn[owner].name)), "")

    def _corners(self, loop: tuple[Side, ...]) -> int:
        """How many corners a loop has."""
        count = 0
        curved = [side.curve.kind not in ("line", "polyline") for side in loop]
        for i, side in enumerate(loop):
            least = max(self.corner_angle, SMOOTH) if curved[i] else self.corner_angle
            count += int((measures.inner_turns(side.curve) > least).sum())
            least = max(least, SMOOTH) if curved[i - 1] else least
            before = measures.end_directions(loop[i - 1].curve)
            after = measures.end_directions(side.curve)
            arrive = -before[0] if loop[i - 1].back else before[1]
            leave = -after[1] if side.back else after[0]
            count += measures.turn_angle(arrive, leave) > least
        return count

    def _pinches(
        self, faces: Faces, material: Sequence[bool], ways: list[list[list[Way]]], network: Network
    ) -> dict[int, Points]:
        """Places (2,) at which regions touch themselves, so that two parts of what is not material
        meet in one point there; by region.
        """
        crowded = set(np.flatnonzero(network.degrees() > 3).tolist())
        if not crowded:
            return {}
        empty: Counter[int] = Counter()
        for i, (left, right) in self._sides(faces).items():
            # on the left of each edge that leaves a node begins one sector of it
            for node, face in ((faces.edges[i].a, left), (faces.edges[i].b, right)):
                empty[node] += node in crowded and not (face >= 0 and material[face])
        found: dict[int, Points] = {}
        for k, loops in enumerate(ways):
            visits: Counter[int] = Counter()
            for loop in loops:
                visits.update(faces.edges[e].b if back else faces.edges[e].a for e, back in loop)
            for node in sorted(crowded & visits.keys()):
                if visits[node] > 1 and empty[node] > 1:
                    found.setdefault(k, network.nodes[node])
        return found

    def _crossings(self, faces: Faces, ways: list[list[list[Way]]], network: Network) -> list[str]:
        """For each region, a sentence on where its boundary crosses another curve."""
        of: dict[int, list[int]] = {}
        for k, loops in enumerate(ways):
            for i in {edge for loop in loops for edge, _ in loop}:
                of.setdefault(i, []).append(k)
        kept = sorted({i for face in faces.faces for i, _ in face.ways})
        edges = [faces.edges[i] for i in kept]
        found = [""] * len(ways)
        for crossing in crossings(edges, network.nodes, self.tolerance, self.size):
            place = place_words(crossing.place)
            alone = crossing.one == crossing.other
            verb = "touches" if crossing.touches else "crosses"
            what = "itself" if alone else "another line or curve"
            for i in (crossing.one, crossing.other):
                for k in of.get(kept[i], []):
                    found[k] = found[k] or f"the boundary {verb} {what} at {place}"
        return found
