"""The history: one row per undoable step, and the scores that follow from the rows."""

from collections.abc import Iterator, Sequence

from msgspec import Struct

from meshwright.document.branches import Branch, Branches, pruned
from meshwright.document.json_records import WholeNumber
from meshwright_core.history.packed_steps import Steps

YOU = "you"
"""Author of the steps that a person takes; a policy's steps carry the policy's name."""


class HistoryStep(Struct, array_like=True, frozen=True, forbid_unknown_fields=True):
    """One step of the mesh.

    ``action`` is an operation's value ("flip_left") or a document action ("clean_all", "smooth",
    "desired", ...); ``halfedge`` is -1 where no half-edge was meant. ``before`` and ``after`` are
    scores s; ``optimum`` is s* after the step. ``start`` and ``best`` are the score that the
    normalised return counts from and the lowest score since: a step that changes desired degrees
    changes the task, so both start again there. In files a step is an array of these values.
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
    """Rows with a cursor: rows before it are done, rows from it on are undone.

    Rows that were undone when another one was appended are kept as a branch.
    """

    def __init__(self, score: int, optimum: int) -> None:
        """`score` and `optimum` are those of the mesh before its first row."""
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
        """A history as it was kept: ``serial`` and ``made`` are the last ones given away."""
        history = cls(score, optimum)
        history._rows, history._cursor, history._branches = list(rows), cursor, branches
        history._serial, history._made = serial, made
        return history

    def __len__(self) -> int:
        return len(self._rows)

    def __getitem__(self, index: int) -> HistoryStep:
        return self._rows[index]

    def __iter__(self) -> Iterator[HistoryStep]:
        return iter(self._rows)

    @property
    def cursor(self) -> int:
        """Number of rows that are done."""
        return self._cursor

    @property
    def last(self) -> HistoryStep | None:
        """The last row that is done, None at the start."""
        return self._rows[self._cursor - 1] if self._cursor else None

    @property
    def mark(self) -> int:
        """A number that names the present state: the last done row's serial, 0 at the start."""
        return self.last.serial if self.last else 0

    @property
    def first(self) -> tuple[int, int]:
        """s and s* before the first row."""
        return self._score, self._optimum

    @property
    def given(self) -> tuple[int, int]:
        """The last serial and the last branch's number that were given away."""
        return self._serial, self._made

    @property
    def branches(self) -> Branches:
        """What was undone and left: rows that fork from the present line."""
        return self._branches

    @property
    def start_score(self) -> int:
        """The score that the normalised return counts from."""
        return self.last.start if self.last else self._score

    @property
    def best_score(self) -> int:
        """The lowest score on the way from the start to the cursor."""
        return self.last.best if self.last else self._score

    @property
    def can_undo(self) -> bool:
        """True if a row is done."""
        return self._cursor > 0

    @property
    def can_redo(self) -> bool:
        """True if a row is undone."""
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
        """Add a done row at the cursor; rows that were undone become a branch.

        ``undone`` are the mesh's steps of these rows.
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
        """Change the rows from the cursor on for those of a branch that forks there.

        ``undone`` are the mesh's steps of the former, the answer those of the latter.
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
        """Those that fork at the cursor or before it."""
        return [branch for branch in self._branches if branch.at <= self._cursor]

    def _tail(self, undone: tuple[Steps, ...]) -> Branch:
        """The undone rows as a branch, with all that fork on them."""
        self._made += 1
        on_it = tuple(branch for branch in self._branches if branch.at > self._cursor)
        return Branch(self._cursor, tuple(self._rows[self._cursor :]), undone, on_it, self._made)

    def step_back(self) -> None:
        """Move the cursor over one row towards the start; the caller has undone the mesh."""
        self._cursor -= 1

    def step_forward(self) -> None:
        """Move the cursor over one row towards the end; the caller has redone the mesh."""
        self._cursor += 1

    def best_index(self, first: int) -> int:
        """Cursor of the earliest state with the lowest score from cursor ``first`` to here."""
        scores = [self._rows[first].before] if first < self._cursor else []
        scores += [row.after for row in self._rows[first : self._cursor]]
        return first + scores.index(min(scores)) if scores else self._cursor
