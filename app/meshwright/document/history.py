"""The history: the undoable steps of a document, and the scores that follow from them."""

from collections.abc import Iterator, Sequence

from msgspec import Struct

from meshwright.document.branches import Branch, Branches, pruned
from meshwright.document.json_records import WholeNumber
from meshwright_core.history.packed_steps import Steps

YOU = "you"
"""Author of the user's own steps; the steps of a policy carry the policy's name."""

SHOWN = 10
"""Steps before and after the present one that a history prints."""


class HistoryStep(Struct, array_like=True, frozen=True, forbid_unknown_fields=True):
    """One step of the mesh.

    ``action`` is an operation's value ("flip_left") or a document action ("clean_all", "smooth",
    "desired", ...); ``halfedge`` is -1 if there is none. ``before`` and ``after`` are scores s;
    ``optimum`` is s* after the step. ``start`` is the score from which the normalised return is
    measured, ``best`` the lowest score since: a step that changes desired degrees changes the
    task, so both start again there. In files a step is an array of these values.
    """

    serial: WholeNumber
    action: str
    title: str
    halfedge: WholeNumber
    by: str
    before: WholeNumber
    after: WholeNumber
    optimum: WholeNumber
    start: WholeNumber
    best: WholeNumber

    @property
    def change(self) -> int:
        """Score after less score before; negative is better."""
        return self.after - self.before


class History:
    """Steps with a cursor: those before it are done, those from it on are undone.

    Steps that were undone when another one was appended are kept as a branch.
    """

    def __init__(self, score: int, optimum: int) -> None:
        """`score` and `optimum` are those of the mesh before its first step."""
        self._rows: list[HistoryStep] = []
        self._branches: Branches = ()
        self._cursor = 0
        self._serial = 0
        self._made = 0
        self._score = score
        self._optimum = optimum

    @classmethod
    def of(
        cls,
        score: int,
        optimum: int,
        rows: Sequence[HistoryStep],
        cursor: int,
        branches: Branches = (),
        serial: int = 0,
        made: int = 0,
    ) -> "History":
        """A stored history: ``serial`` and ``made`` are the last numbers that it has used."""
        history = cls(score, optimum)
        history._rows, history._cursor, history._branches = list(rows), cursor, branches
        history._serial, history._made = serial, made
        return history

    def __repr__(self) -> str:
        """The last steps that are done and the next ones, one a line; an arrow marks the state."""
        low = max(0, self._cursor - SHOWN)
        rows = self._rows[low : self._cursor + SHOWN]
        width = max((len(row.title) for row in rows), default=0)
        branches = f", {len(self._branches)} branches" if self._branches else ""
        lines = [
            f"{self._cursor} of {len(self._rows)} steps done{branches}; s {self._score} at first"
        ]
        for number, row in enumerate(rows, low + 1):
            mark = "\u2192" if number == self._cursor else " "
            lines.append(f"{mark} {number:4}  {row.title:{width}}  s {row.after}  by {row.by}")
        return "\n".join(lines)

    def __len__(self) -> int:
        return len(self._rows)

    def __getitem__(self, index: int) -> HistoryStep:
        return self._rows[index]

    def __iter__(self) -> Iterator[HistoryStep]:
        return iter(self._rows)

    @property
    def cursor(self) -> int:
        """Number of steps that are done."""
        return self._cursor

    @property
    def last(self) -> HistoryStep | None:
        """The last step that is done, None at the start."""
        return self._rows[self._cursor - 1] if self._cursor else None

    @property
    def mark(self) -> int:
        """Serial of the last step that is done, 0 at the start: identifies the state."""
        return self.last.serial if self.last else 0

    @property
    def first(self) -> tuple[int, int]:
        """s and s* before the first step."""
        return self._score, self._optimum

    @property
    def given(self) -> tuple[int, int]:
        """The last serial and the last branch number that were used."""
        return self._serial, self._made

    @property
    def branches(self) -> Branches:
        """Undone steps that were replaced by others."""
        return self._branches

    @property
    def start_score(self) -> int:
        """The score from which the normalised return is measured."""
        return self.last.start if self.last else self._score

    @property
    def best_score(self) -> int:
        """The lowest score on the way from the start to the cursor."""
        return self.last.best if self.last else self._score

    @property
    def can_undo(self) -> bool:
        """True if a step is done."""
        return self._cursor > 0

    @property
    def can_redo(self) -> bool:
        """True if a step is undone."""
        return self._cursor < len(self._rows)

    def append(
        self,
        action: str,
        title: str,
        halfedge: int,
        by: str,
        before: int,
        after: int,
        optimum: int,
        undone: tuple[Steps, ...] = (),
    ) -> HistoryStep:
        """Add a done step at the cursor; steps that were undone become a branch.

        ``undone`` is the mesh's own record of the undone steps.
        """
        last = self.last
        same_task = optimum == (last.optimum if last else self._optimum) and action != "desired"
        self._serial += 1
        row = HistoryStep(
            serial=self._serial,
            action=action,
            title=title,
            halfedge=halfedge,
            by=by,
            before=before,
            after=after,
            optimum=optimum,
            start=self.start_score if same_task else after,
            best=min(self.best_score, after) if same_task else after,
        )
        if self.can_redo:
            self._branches = pruned((*self._branches_here(), self._tail(undone)), self._made)
        del self._rows[self._cursor :]
        self._rows.append(row)
        self._cursor += 1
        return row

    def take(self, index: int, undone: tuple[Steps, ...]) -> tuple[Steps, ...]:
        """Replace the steps after the cursor by those of a branch that starts there.

        ``undone`` is the mesh's own record of the former; returns that of the latter.
        """
        taken = self._branches[index]
        if taken.at != self._cursor:
            raise ValueError(f"branch {index} forks at {taken.at}, not at {self._cursor}")
        here = [
            self._tail(undone) if branch is taken else branch
            for branch in self._branches_here()
            if branch is not taken or self.can_redo
        ]
        self._rows[self._cursor :] = taken.rows
        self._branches = (*here, *taken.branches)
        return taken.steps

    def _branches_here(self) -> list[Branch]:
        """The branches that start at the cursor or before it."""
        return [branch for branch in self._branches if branch.at <= self._cursor]

    def _tail(self, undone: tuple[Steps, ...]) -> Branch:
        """The undone steps as a branch, with the branches that start on them."""
        self._made += 1
        on_it = tuple(branch for branch in self._branches if branch.at > self._cursor)
        return Branch(self._cursor, tuple(self._rows[self._cursor :]), undone, on_it, self._made)

    def rewind(self, cursor: int) -> None:
        """Drop the steps after ``cursor``, and the branches that start on them: the mesh has
        forgotten them.
        """
        del self._rows[cursor:]
        self._cursor = min(self._cursor, cursor)
        self._branches = tuple(branch for branch in self._branches if branch.at <= cursor)

    def step_back(self) -> None:
        """Move the cursor back by one step; the caller has undone it on the mesh."""
        self._cursor -= 1

    def step_forward(self) -> None:
        """Move the cursor forward by one step; the caller has redone it on the mesh."""
        self._cursor += 1

    def best_index(self, first: int) -> int:
        """Cursor of the earliest state with the lowest score from cursor ``first`` to here."""
        scores = [self._rows[first].before] if first < self._cursor else []
        scores += [row.after for row in self._rows[first : self._cursor]]
        return first + scores.index(min(scores)) if scores else self._cursor
