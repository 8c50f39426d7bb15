"""Fuzzy matching of a few typed letters."""

from dataclasses import dataclass

_START, _RUN, _LETTER, _GAP = 8.0, 9.0, 1.0, 0.08


@dataclass(frozen=True)
class Match:
    """The score of a match (higher is better), and the matched positions in the text."""

    score: float
    places: tuple[int, ...]


def match(query: str, text: str) -> Match | None:
    """The best match of the letters of ``query`` in ``text``, in their order; None if there is
    none.

    Spaces and capitals of the query are ignored. Consecutive letters and letters at the start of
    words count most, so ``st`` finds "Step" first, then "Show the tour", and "Best" last.
    """
    wanted = "".join(query.lower().split())
    lower = text.lower()
    if not wanted:
        return Match(0.0, ())
    if len(lower) != len(text):  # a few capitals have two letters in lower case
        lower = text
    # best[j]: score and places of the letters so far when the last of them is text[j]
    best: list[tuple[float, tuple[int, ...]] | None] = [None] * len(lower)
    for number, letter in enumerate(wanted):
        row: list[tuple[float, tuple[int, ...]] | None] = [None] * len(lower)
        ahead: tuple[float, tuple[int, ...]] | None = (0.0, ()) if number == 0 else None
        for j, here in enumerate(lower):
            if here == letter and ahead is not None:
                row[j] = (ahead[0] + _worth(lower, j), (*ahead[1], j))
            before = best[j - 1] if number and j else None
            if here == letter and before is not None:
                run = (before[0] + _RUN + _worth(lower, j), (*before[1], j))
                row[j] = max(row[j] or run, run, key=lambda found: found[0])
            found = best[j] if number else None
            if found is not None and (ahead is None or found[0] > ahead[0]):
                ahead = found
            elif ahead is not None:
                ahead = (ahead[0] - _GAP, ahead[1])
        best = row
    ends = [found for found in best if found is not None]
    if not ends:
        return None
    score, places = max(ends, key=lambda found: found[0])
    return Match(score - 0.01 * len(text), places)


def _worth(text: str, place: int) -> float:
    starts = place == 0 or not text[place - 1].isalnum()
    return _LETTER + (_START if starts else 0.0)
