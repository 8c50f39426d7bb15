"""Names of sides and regions as text.

A name is one line of text. A side or region may be in several groups at once, as elements and edges
of mesh files are: its name then holds theirs, separated by semicolons. A group that comes from an
array of whole numbers is called "array=value".
"""

from __future__ import annotations

import re
from collections.abc import Iterable

LONGEST = 200
"""Characters of the name of one group, at most."""
SEPARATOR = ";"
_NUMBERED = re.compile(r"(?P<array>[^=]+)=(?P<value>-?\d{1,18})")


def safe(name: str) -> str:
    """The name of one group without what separates names, line breaks and other controls."""
    text = "".join(" " if not c.isprintable() else "," if c == SEPARATOR else c for c in name)
    return " ".join(text.split())[:LONGEST].rstrip()


def joined(names: Iterable[str]) -> str:
    """One name from those of groups, each once, in their order."""
    return (SEPARATOR + " ").join(dict.fromkeys(name for name in names if name))


def groups(name: str) -> tuple[str, ...]:
    """The groups that a name consists of; none for ""."""
    return tuple(dict.fromkeys(part for one in name.split(SEPARATOR) if (part := safe(one))))


def clean(name: str) -> str:
    """A name as a user types it, made one that is sound: blanks and empty groups removed."""
    return joined(groups(name))


def numbered(group: str) -> tuple[str, int] | None:
    """The array and value of a group "array=value", None for any other."""
    found = _NUMBERED.fullmatch(group)
    return (found["array"], int(found["value"])) if found else None
