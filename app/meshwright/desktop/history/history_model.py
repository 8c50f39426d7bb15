"""The history as a Qt list model: the start, every step, and branches where they fork."""

from bisect import bisect_left
from dataclasses import dataclass

from qtpy.QtCore import QAbstractListModel, QModelIndex, QPersistentModelIndex, Qt

from meshwright.desktop.widgets.wording import branch_words, step_words
from meshwright.document.branches import Branches
from meshwright.document.history import History, HistoryStep


@dataclass(frozen=True)
class HistoryLine:
    """One line of the list: a state, or with ``branch`` >= 0 a branch that forks at ``state``."""

    state: int
    row: HistoryStep | None
    branch: int = -1


class HistoryModel(QAbstractListModel):
    """A list model of a history; lines are computed, so that the cost does not grow with their
    number.
    """

    def __init__(self) -> None:
        super().__init__()
        self._history = History(0, 0)
        self._branches: Branches = ()
        self._order: list[int] = []
        self._places: list[int] = []
        self._rows: list[HistoryStep] = []  # a copy: the history may have changed since
        self._empty = True
        self.highest = 0
        """The highest score in the list."""

    def rowCount(self, parent: QModelIndex | QPersistentModelIndex | None = None) -> int:  # noqa: N802
        """The number of lines."""
        if self._empty or (parent is not None and parent.isValid()):
            return 0
        return len(self._rows) + 1 + len(self._places)

    def line(self, place: int) -> HistoryLine:
        """The line at a position in the list."""
        before = bisect_left(self._places, place)
        if before < len(self._places) and self._places[before] == place:
            branch = self._order[before]
            return HistoryLine(self._branches[branch].at, None, branch)
        state = place - before
        return HistoryLine(state, self._rows[state - 1] if state else None)

    def place(self, state: int) -> int:
        """The position of a state in the list."""
        return state + sum(1 for branch in self._branches if branch.at < state)

    @property
    def history(self) -> History:
        """The history that is shown."""
        return self._history

    @property
    def branches(self) -> Branches:
        """The branches that are shown."""
        return self._branches

    @property
    def current(self) -> bool:
        """Whether the branches that are shown are those of the history."""
        return self._branches is self._history.branches

    def data(
        self, index: QModelIndex | QPersistentModelIndex, role: int = Qt.ItemDataRole.DisplayRole
    ) -> object:
        """Text for screen readers and tooltips; the delegate paints from lines."""
        if role not in (Qt.ItemDataRole.DisplayRole, Qt.ItemDataRole.ToolTipRole):
            return None
        if not 0 <= index.row() < self.rowCount():
            return None
        line = self.line(index.row())
        if line.branch >= 0:
            branch = self._branches[line.branch]
            further = len(branch.branches)
            more = f", and {further} more on it" if further else ""
            return f"{branch_words(branch.rows)}, from step {branch.at:,}{more}"
        if line.row is None:
            return f"Start, s {self._history.first[0]:,}"
        return f"Step {line.state:,}: {step_words(line.row)}, s {line.row.after:,}"

    def follow(self, history: History, empty: bool) -> None:
        """Update the list from ``history``; appends lines where that is enough, else resets the
        model.
        """
        known, count = len(self._rows), len(history)
        same = history is self._history and empty == self._empty
        same = same and self._branches is history.branches
        # a row always comes after the same rows: see meshwright.document.score_series.ScoreSeries
        kept = same and (
            known == 0 or (known <= count and history[known - 1] is self._rows[known - 1])
        )
        if kept and count == known:
            return
        if kept:
            first = self.rowCount()
            self.beginInsertRows(QModelIndex(), first, first + count - known - 1)
            fresh = [history[i] for i in range(known, count)]
            self._rows += fresh
        else:
            self.beginResetModel()
            fresh = self._rows = list(history)
            self.highest = history.first[0]
        self.highest = max([self.highest, *(row.after for row in fresh)])
        self._history, self._branches, self._empty = history, history.branches, empty
        self._order = sorted(range(len(self._branches)), key=lambda i: self._branches[i].at)
        self._places = [self._branches[b].at + 1 + i for i, b in enumerate(self._order)]
        if kept:
            self.endInsertRows()
        else:
            self.endResetModel()
