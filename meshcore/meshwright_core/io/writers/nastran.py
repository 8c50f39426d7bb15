"""Nastran bulk data files: names of regions are properties, named as HyperMesh does."""

from __future__ import annotations

from meshwright_core.errors import MeshError
from meshwright_core.io.content import Content
from meshwright_core.io.named_groups import region_groups
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
    found = region_groups(content, kind, count)
    bare = any(row < 0 for row in found.rows)
    comments = [
        f'$HMNAME PROP          {tag:>8}"{key.replace(chr(34), chr(39))}"'
        for key, tag in found.tags.items()
        if not (key.startswith("region=") and bare) and key != f"property={tag}"
    ]
    return found.numbers().tolist(), comments


def _in_16(value: float) -> str:
    """Return the number with as many digits as fit in 16 characters."""
    for digits in range(17, 0, -1):
        shown = f"{value:#.{digits}g}".upper()
        if len(shown) <= 16:
            return shown
    raise MeshError(f"the coordinate {value!r} does not fit in 16 characters")
