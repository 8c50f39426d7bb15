"""What was found in a drawing: its regions, what was mended, and what was left out."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

from meshwright_core.curves.curve import Curve
from meshwright_core.errors import MeshError
from meshwright_core.io.drawings.drawn import Points, listed

ALL = "all"
"""Chooses all regions."""


@dataclass(frozen=True)
class Side:
    """A curve of the boundary of a region, in the direction in which it was drawn.

    Attributes:
        curve: where it runs.
        back: whether the boundary, with the region on the left, runs along it backwards.
        name: of the curve in the drawing, "" if it has none.
    """

    curve: Curve
    back: bool
    name: str

    @property
    def along(self) -> Curve:
        """The curve with the region on its left."""
        return self.curve.reversed if self.back else self.curve


@dataclass(frozen=True)
class FoundRegion:
    """A region of a drawing.

    Attributes:
        name: unique in the drawing.
        area: exact, its holes taken off.
        holes: how many holes it has; parts of other regions inside of it are none.
        corners: points of its boundary at which that turns.
        layer: of its outline, "" if there is none or several.
        loops: the outline, then what bounds it inside; sides end to end.
        inside: a point (2,) in it.
        touches: regions with which it shares a part of its boundary, by index.
        crossing: a sentence on where its boundary crosses or touches another one, or itself, ""
            if it does not.
    """

    name: str
    area: float
    holes: int
    corners: int
    layer: str
    loops: tuple[tuple[Side, ...], ...]
    inside: Points
    touches: tuple[int, ...] = ()
    crossing: str = ""


@dataclass
class DrawingReport:
    """What was found in a drawing.

    Attributes:
        regions: the largest one first.
        repairs: sentences, with places, on what was mended.
        ignored: sentences, with counts, on what was left out.
        open_outlines: sentences on outlines that are not closed, with the place and width of the
            gap.
        serious: the first of these, if the outline is open rather than something in it.
        units: of the coordinates, "" if not said.
    """

    regions: list[FoundRegion]
    repairs: list[str] = field(default_factory=list)
    ignored: list[str] = field(default_factory=list)
    open_outlines: list[str] = field(default_factory=list)
    serious: str = ""
    units: str = ""

    def to_json(self) -> dict[str, Any]:
        """The report as a dictionary that ``json.dump`` writes."""
        return {
            "regions": [
                {
                    "name": region.name,
                    "area": region.area,
                    "holes": region.holes,
                    "corners": region.corners,
                    "layer": region.layer,
                    "touches": [self.regions[i].name for i in region.touches],
                }
                for region in self.regions
            ],
            "repairs": self.repairs,
            "ignored": self.ignored,
            "open": self.open_outlines,
            "units": self.units,
        }

    def groups(self) -> list[list[int]]:
        """Regions that touch, directly or through others, together; the largest one first."""
        left = set(range(len(self.regions)))
        groups = []
        while left:
            pending = [min(left)]
            left.discard(pending[0])
            group = []
            while pending:
                i = pending.pop()
                group.append(i)
                ahead = [j for j in self.regions[i].touches if j in left]
                left.difference_update(ahead)
                pending += ahead
            groups.append(sorted(group))
        return groups

    def chosen(self, region: str | int | None = None) -> list[FoundRegion]:
        """The regions to be meshed.

        Args:
            region: names or numbers from 1, separated by commas, or "all"; None for all of them
                if they are connected.

        Raises:
            MeshError: there is no such region; none was named and they lie apart; the outline of
                one crosses or touches another; the outline of the whole is open.
        """
        if region is None:
            if self.serious:
                raise MeshError(self.serious)
            groups = self.groups()
            crossed = [any(self.regions[i].crossing for i in group) for group in groups]
            if len(groups) > 1 and not all(crossed):
                raise MeshError(self._apart(groups))
            found = list(self.regions)
        elif str(region).strip().lower() == ALL:
            found = list(self.regions)
        else:
            found = self._named(str(region))
        for one in found:
            if one.crossing:
                raise MeshError(one.crossing)
        return found

    def _named(self, text: str) -> list[FoundRegion]:
        names = {region.name.lower(): i for i, region in enumerate(self.regions)}
        if text.strip().lower() in names:
            return [self.regions[names[text.strip().lower()]]]
        chosen = set()
        for word in text.split(","):
            key = word.strip()
            number = int(key) if key.isdecimal() and len(key) < 10 else 0
            if key.lower() in names:
                chosen.add(names[key.lower()])
            elif 1 <= number <= len(self.regions):
                chosen.add(number - 1)
            else:
                there = listed([f"{r.name!r} ({i})" for i, r in enumerate(self.regions, 1)])
                raise MeshError(f"there is no region {key[:40]!r}; the drawing has {there}")
        return [self.regions[i] for i in sorted(chosen)]

    def _apart(self, groups: list[list[int]]) -> str:
        parts = [
            f"{i + 1} {self.regions[i].name!r} (area {self.regions[i].area:.6g})"
            for group in groups
            for i in group[:1]
        ]
        return (
            f"there are {len(groups):,} separate outlines, {listed(parts)}; "
            f"choose by --region NAME, number or {ALL}"
        )
