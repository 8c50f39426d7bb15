"""Nastran bulk data files: names of regions are properties, named as HyperMesh does."""

from __future__ import annotations

import numpy as np

from meshwright_core.errors import MeshError
from meshwright_core.io.content import Content
from meshwright_core.io.named_groups import tags_of, unique_pairs
from meshwright_core.io.writers import lines as form


def write(content: Content) -> str:
    """Return the content as a Nastran bulk data file, coordinates in fields of 16 characters.

    A region is a property; several names of one are joined. Its name stands in a comment
    `$HMNAME PROP`.
    """
    kind, elements = form.block(content)
    card = {"triangle": "CTRIA3", "quad": "CQUAD4"}[kind]
    if max(len(content.points), len(elements)) > 99_999_999:
        raise MeshError("a Nastran file numbers at most 99999999 points and elements")
    property_of, comments = _properties(content, kind, len(elements))
    lines = [form.head(content, "$"), "BEGIN BULK", *comments]
    for i, point in form.numbered(content.points):
        x, y, z = (_in_16(value) for value in point)
        lines += [f"GRID*   {i:<16}{'':16}{x:>16}{y:>16}", f"*       {z:>16}"]
    for (i, nodes), owner in zip(form.numbered(elements + 1), property_of, strict=True):
        lines.append(f"{card:<8}{i:<8}{owner:<8}" + "".join(f"{node:<8}" for node in nodes))
    return form.text([*lines, "ENDDATA"])


def _properties(content: Content, kind: str, count: int) -> tuple[list[int], list[str]]:
    """The property of each element, and the comments that name properties."""
    names = form.names(content)
    numbers = (content.regions or {}).get(kind)
    numbers = np.zeros(count, np.int64) if numbers is None else np.asarray(numbers)
    row = names.elements.get(kind, np.full(count, -1, np.int64))
    pairs, place = unique_pairs(numbers, row)
    bare = [int(number) for number, one in pairs if one < 0]
    keys = [names.regions[int(one)] if one >= 0 else f"region={int(n) + 1}" for n, one in pairs]
    tags = tags_of(list(dict.fromkeys(keys)), 2, names.tags)
    owners = np.array([tags[key] for key in keys])[place]
    comments = [
        f'$HMNAME PROP          {tag:>8}"{key.replace(chr(34), chr(39))}"'
        for key, tag in tags.items()
        if not (key.startswith("region=") and bare) and key != f"property={tag}"
    ]
    return owners.tolist(), comments


def _in_16(value: float) -> str:
    """Return the number with as many digits as fit in 16 characters."""
    for digits in range(17, 0, -1):
        shown = f"{value:#.{digits}g}".upper()
        if len(shown) <= 16:
            return shown
    raise MeshError(f"the coordinate {value!r} does not fit in 16 characters")
