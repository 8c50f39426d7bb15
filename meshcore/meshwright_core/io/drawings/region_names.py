"""Names of regions: given ones, those of layers, or numbers."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence


def named(given: Sequence[str], layers: Sequence[set[str]]) -> tuple[list[str], list[str]]:
    """Return a unique name, and a layer, for each region.

    Args:
        given: names, "" where there is none.
        layers: those on which the whole outline of each region is drawn. An interface is drawn on
            the layers of both its sides, so that a region may have several candidates: a layer
            that is the only one of another region is then taken away.
    """
    chosen = [set(candidates) - {""} for candidates in layers]
    for _ in chosen:
        sure = {next(iter(one)) for one in chosen if len(one) == 1}
        open_ones = [one for one in chosen if len(one) > 1 and one & sure]
        if not open_ones:
            break
        for one in open_ones:
            left = one - sure
            if left:
                one &= left
            else:
                one.clear()
    layer = [next(iter(one)) if len(one) == 1 else "" for one in chosen]
    wanted = [name or own for name, own in zip(given, layer, strict=True)]
    times = Counter(name.lower() for name in wanted if name)
    used: Counter[str] = Counter()
    names = []
    taken = {name.lower() for name in wanted if times[name.lower()] == 1}
    for i, name in enumerate(wanted, 1):
        if not name:
            name = f"region {i}"
        elif times[name.lower()] > 1:
            used[name.lower()] += 1
            name = f"{name} {used[name.lower()]}"
        if wanted[i - 1] != name:
            while name.lower() in taken:
                name += "'"
            taken.add(name.lower())
        names.append(name)
    return names, layer
