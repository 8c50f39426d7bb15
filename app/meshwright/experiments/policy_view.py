"""Input and output of a policy at a half-edge: template, field of view, probabilities."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from meshwright.assistant.torch_threads import one_thread
from meshwright.experiments.mesh_thumbnail import MARGIN, given_mesh, thumbnail
from meshwright.experiments.picture import Picture, shifted
from meshwright.experiments.rollouts import known_policy, require_kind
from meshwright.experiments.template_figure import template_figure
from meshwright.graphics.drawing import Disc, Drawing, Line, Polygon, Text
from meshwright.graphics.halfedge_arrow import arrow
from meshwright.graphics.markers import label
from meshwright.graphics.mesh_figure import below_edges
from meshwright.graphics.theme import LIGHT, Theme
from meshwright.graphics.viewport import Viewport
from meshwright_core import HalfEdgeMesh, MeshError
from meshwright_core.arguments import whole_number
from meshwright_core.core.arrays import ORIGIN
from meshwright_core.errors import sentence
from meshwright_core.geometry.edge_lines import EdgeLines
from meshwright_core.operations.catalogue import CATALOGUE, Operation

if TYPE_CHECKING:
    from meshwright_agent.policy.policy_files import Policy
    from meshwright_agent.policy.what_if import Outlook

MESH, FLAT = (456, 400), (400, 400)
ROW, BAR, GAP = 24.0, 288.0, 24


def policy_view(mesh: Any, policy: str | Policy, halfedge: int | None = None) -> PolicyView:
    """Evaluate a policy at one half-edge of a mesh.

    Args:
        mesh: as :func:`meshwright.experiments.compare` takes it; it is not changed.
        policy: the name of a shipped policy, a policy file, or a loaded policy.
        halfedge: a policy that reads one template gets that of this half-edge; one with a
            shortlist gets it as one of its candidates. None: the half-edge of the most probable
            operation.

    Raises MeshError for a wrong policy, or a half-edge that does not exist.
    """
    from meshwright_agent.policy.policy_files import PolicyError
    from meshwright_agent.policy.what_if import candidates, outlook

    shown = given_mesh(mesh)
    known = known_policy(policy)
    require_kind(known, shown)
    if halfedge is not None:
        halfedge = whole_number(halfedge, 0, "A half-edge")
    try:
        with one_thread():
            among = candidates(shown, known, -1 if halfedge is None else halfedge)
            if not len(among):
                raise MeshError("This mesh is regular: the policy has nothing to look at.")
            seen = outlook(shown, known, among)
    except PolicyError as error:
        raise MeshError(sentence(str(error))) from None
    h = int(among[seen.probabilities.max(axis=1).argmax()]) if halfedge is None else halfedge
    return PolicyView(shown, known, h, seen)


class PolicyView(Picture):
    """Input and output of a policy at one half-edge."""

    def __init__(self, mesh: HalfEdgeMesh, policy: Policy, halfedge: int, seen: Outlook) -> None:
        from meshwright_agent.policy.explanation import field_of_view, template_of
        from meshwright_agent.policy.what_if import template_slots

        self._task = task = policy.task
        arrays = mesh.arrays
        self.mesh, self.policy, self.halfedge = mesh, policy.name, halfedge
        self.slots: np.ndarray = template_slots(arrays, task, halfedge)
        """(N,) the half-edge in each slot of its template, -1 beyond the boundary."""
        self.template: np.ndarray = template_of(arrays, task, halfedge)[0]
        """(T, 3) vertex, slot and ring of each vertex in the template, as it is met."""
        self.field: np.ndarray = field_of_view(arrays, task.k, task.blocks, halfedge)
        """(M, 2) elements that its embedding depends on, and the block that each comes in with."""
        self.operations: tuple[Operation, ...] = tuple(
            info.operation for info in CATALOGUE if info.kind == mesh.kind
        )[: task.operations]
        """The A operations that the policy has."""
        self.halfedges = seen.halfedges
        """(K,) the half-edges among which it chooses."""
        self.probabilities = seen.probabilities
        """(K, A) of every operation at each; they sum to 1."""
        self.permitted = seen.permitted
        """(K, A) the action mask."""
        self.changes = seen.changes
        """(K, A) the exact change of s of what is permitted."""
        self.value = seen.value
        """What it expects of the normalised return; no number where nothing is permitted."""

    def __repr__(self) -> str:
        lines = [
            f"{self.policy} at half-edge {self.halfedge}: {len(self.template)} vertices in its"
            f" template, {len(self.field)} elements in its field of view,"
            f" {len(self.halfedges)} half-edges to choose among"
        ]
        lines += [
            f"  {row['title']}: {row['probability']:.1%}, {label(row['change'])}"
            if row["allowed"]
            else f"  {row['title']}: {row['reason']}"
            for row in self.choices
        ]
        return "\n".join(lines)

    @property
    def vertices(self) -> np.ndarray:
        """(N,) the vertex that each slot of the template reads, -1 beyond the boundary."""
        k = self.mesh.k
        there = self.slots >= 0
        h = np.where(there, self.slots, 0)
        if k == 3:  # the one across
            h = h - h % 3 + (h + 2) % 3
        return np.where(there, self.mesh.arrays.edge[h, ORIGIN].astype(np.int64), -1)

    @property
    def delta(self) -> np.ndarray:
        """(N,) the irregularity of the vertex of each slot, 0 beyond the boundary."""
        seen = self.vertices
        return np.where(seen >= 0, self.mesh.irregularity()[np.maximum(seen, 0)], 0)

    @property
    def choices(self) -> list[dict[str, Any]]:
        """One dictionary for each operation at the half-edge itself."""
        i = int(np.flatnonzero(self.halfedges == self.halfedge)[0])
        titles = {info.operation: info.title for info in CATALOGUE if info.kind == self.mesh.kind}
        return [
            {
                "operation": operation.value,
                "title": titles[operation],
                "halfedge": self.halfedge,
                "allowed": bool(self.permitted[i, j]),
                "reason": self._reason(operation, bool(self.permitted[i, j])),
                "change": int(self.changes[i, j]) if self.permitted[i, j] else None,
                "probability": float(self.probabilities[i, j]),
            }
            for j, operation in enumerate(self.operations)
        ]

    @property
    def rows(self) -> list[dict[str, Any]]:
        """One dictionary for each permitted operation, the most probable first."""
        found = [
            {
                "operation": self.operations[j].value,
                "halfedge": int(self.halfedges[i]),
                "change": int(self.changes[i, j]),
                "probability": float(self.probabilities[i, j]),
            }
            for i, j in np.argwhere(self.permitted).tolist()
        ]
        return sorted(found, key=lambda row: -row["probability"])

    def _reason(self, operation: Operation, permitted: bool) -> str:
        if permitted:
            return ""
        verdict = self.mesh.check(operation, self.halfedge)
        if not verdict:
            return str(verdict.reason)
        capped = self.mesh.copy()
        capped.degree_cap = self._task.cap
        if not (verdict := capped.check(operation, self.halfedge)):
            return f"not for this policy: {verdict.reason}"
        floor, ceiling = self._task.bounds(self.mesh.n_elements)
        if operation == Operation.COLLAPSE:
            return f"not for this policy: it keeps at least {floor} elements"
        return f"not for this policy: it keeps to {ceiling} elements at most"

    # The picture

    def drawing(self, theme: Theme = LIGHT) -> Drawing:
        """The mesh near the half-edge, its template in the plane, and probabilities as bars."""
        rows = self.choices
        top, foot = 32, 40
        width = MESH[0] + GAP + FLAT[0] + 2 * GAP
        height = top + MESH[1] + foot + round(ROW * len(rows)) + 24
        drawing = Drawing((width, height), theme.background, repr(self).split("\n")[0])
        left = float(GAP)
        drawing.add(*(shifted(shape, left, top) for shape in self._near(theme).shapes))
        drawing.add(*_mat(drawing.size, (left, float(top)), MESH, theme))
        drawing.add(
            Text(f"{self.policy} at half-edge {self.halfedge}", (left, 18.0), 14.0, theme.text,
                 "left", True),
            Text("its template, laid out flat; numbers are slots", (left + MESH[0] + GAP, 18.0),
                 12.0, theme.muted),
        )  # fmt: skip
        flat = template_figure(self.mesh.k, self.vertices, self.mesh.irregularity(), FLAT, theme)
        drawing.add(*(shifted(shape, left + MESH[0] + GAP, top) for shape in flat.shapes))
        words = (
            f"tint: its field of view, {len(self.field)} elements, each with the block of"
            " convolution that brings it in; rings: its template"
        )
        drawing.add(Text(words, (left, top + MESH[1] + 16.0), 12.0, theme.muted))
        self._add_bars(drawing, theme, rows, left, top + MESH[1] + foot + 12.0)
        return drawing

    def _near(self, theme: Theme) -> Drawing:
        mesh, k = self.mesh, self.mesh.k
        corners = mesh.points[mesh.corners(self.field[:, 0])][:, :, :2]
        seen = mesh.points[self.template[:, 0], :2]
        window = np.concatenate([corners.reshape(-1, 2), seen])
        view = Viewport(size=MESH).fitted(window, MARGIN + 16.0)
        drawing = thumbnail(mesh, MESH, theme, _box(view))
        screen = view.to_screen(corners)
        outlines = EdgeLines(mesh, view.tolerance).outlines(self.field[:, 0])
        tints = [Polygon(view.to_screen(outline), theme.accent_soft) for outline in outlines]
        edges = below_edges(drawing)
        drawing.shapes[edges:edges] = tints
        for one, block in zip(screen, self.field[:, 1].tolist(), strict=True):
            x, y = one.mean(axis=0).tolist()
            if block:
                drawing.add(Text(str(block), (x, y), 11.5, theme.muted, "middle"))
        own = view.to_screen(mesh.points[mesh.arrays.edge[self._element(), ORIGIN], :2])
        tail, neck, point = arrow(own, self.halfedge % k)
        drawing.add(Line(np.array([tail, neck]), theme.arrow, 2.6), Polygon(point, theme.arrow))
        for (x, y), slot in zip(
            view.to_screen(seen).tolist(), self.template[:, 1].tolist(), strict=True
        ):
            drawing.add(Disc((x, y), 13.0, theme.arrow, 1.6))
            drawing.add(
                Disc((x + 12.0, y + 12.0), 7.5, theme.background),
                Text(str(slot), (x + 12.0, y + 12.0), 10.0, theme.accent, "middle"),
            )
        return drawing

    def _element(self) -> np.ndarray:
        k = self.mesh.k
        return self.halfedge - self.halfedge % k + np.arange(k)

    def _add_bars(
        self, drawing: Drawing, theme: Theme, rows: list[dict[str, Any]], left: float, top: float
    ) -> None:
        bar = left + 136.0
        for i, row in enumerate(rows):
            y = top + ROW * i
            ink = theme.text if row["allowed"] else theme.faint
            drawing.add(Text(row["title"], (left, y), 13.0, ink))
            if not row["allowed"]:
                drawing.add(Text(row["reason"], (bar, y), 12.0, theme.muted))
                continue
            share = row["probability"]
            for length, colour in ((BAR, theme.line), (BAR * share, theme.accent)):
                box = np.array([[0, -5], [length, -5], [length, 5], [0, 5]]) + (bar, y)
                drawing.add(Polygon(box, colour))
            at = bar + BAR + 16.0
            change = f"\N{GREEK CAPITAL LETTER DELTA}s {label(row['change'])}"
            drawing.add(
                Text(f"{share:.1%}", (at + 44.0, y), 13.0, theme.text, "right", share >= 0.5),
                Text(change, (at + 68.0, y), 13.0, theme.muted),
            )


def _box(view: Viewport) -> np.ndarray:
    """Two opposite corners of what the view shows, less the margin of a thumbnail."""
    width, height = view.size
    low = view.to_plane(MARGIN, height - MARGIN)
    high = view.to_plane(width - MARGIN, MARGIN)
    return np.array([low, high])


def _mat(
    size: tuple[int, int], corner: tuple[float, float], window: tuple[int, int], theme: Theme
) -> list[Polygon | Line]:
    """Polygons that cover a drawing outside a rectangle, and the outline of the rectangle."""
    (width, height), (x, y) = size, corner
    right, bottom = x + window[0], y + window[1]
    boxes = (
        (0.0, 0.0, width, y),
        (0.0, bottom, width, height),
        (0.0, y, x, bottom),
        (right, y, width, bottom),
    )
    made: list[Polygon | Line] = [
        Polygon(np.array([[a, b], [c, b], [c, d], [a, d]]), theme.background)
        for a, b, c, d in boxes
    ]
    frame = np.array([[x, y], [right, y], [right, bottom], [x, bottom], [x, y]])
    return [*made, Line(frame, theme.line, 1.0)]
