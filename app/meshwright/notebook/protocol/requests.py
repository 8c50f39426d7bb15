"""What a browser may ask: words with their fields, read strictly.

A message is ``{"do": word, "id": int, "view": str, ...}``. Whatever is not exactly what the word
asks for is refused with one sentence, before anything else looks at it.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

LONGEST = 200
"""Characters of a string, at most."""
LARGEST = 2**53 - 1
"""The largest whole number that a browser can count to."""
DEGREES = 1, 100
"""Bounds of a degree that may be asked for at a vertex."""


class RefusedError(Exception):
    """A message that cannot be taken; its text is a sentence for a person."""

    def __init__(self, sentence: str, request: Request | None = None) -> None:
        super().__init__(sentence)
        self.sentence = sentence
        self.request = request
        """Whom to answer, as far as the message says it; None if it does not."""


@dataclass(frozen=True)
class Request:
    """A message that is well formed: what to do, for which view, and with what."""

    do: str
    id: int
    view: str
    fields: Mapping[str, Any]

    def __getitem__(self, name: str) -> Any:
        return self.fields[name]


Check = Callable[[str, Any], Any]
"""Returns the value of the field with this name, or raises ValueError with the end of a sentence:
``must be ...``."""


def whole(low: int, high: int = LARGEST) -> Check:
    """A whole number from ``low`` to ``high``; true and false are none."""

    def check(name: str, value: Any) -> int:
        if type(value) is not int or not low <= value <= high:
            upper = f" to {high:,}" if high < LARGEST else ""
            raise ValueError(f"must be a whole number from {low}{upper}")
        return value

    return check


def finite(low: float, high: float) -> Check:
    """A number from ``low`` to ``high``."""

    def check(name: str, value: Any) -> float:
        if type(value) not in (int, float) or not (low <= value <= high and math.isfinite(value)):
            raise ValueError(f"must be a number from {low:g} to {high:g}")
        return float(value)

    return check


def boolean(name: str, value: Any) -> bool:
    """True or false."""
    if type(value) is not bool:
        raise ValueError("must be true or false")
    return value


def text(name: str, value: Any) -> str:
    """A string that is not too long."""
    if type(value) is not str or len(value) > LONGEST:
        raise ValueError(f"must be a string of at most {LONGEST} characters")
    return value


def one_of(*words: str) -> Check:
    """One of a few words."""

    def check(name: str, value: Any) -> str:
        if type(value) is not str or value not in words:
            raise ValueError(f"must be one of {', '.join(words)}")
        return value

    return check


def pair(name: str, value: Any) -> tuple[int, int]:
    """Two vertex ids."""
    if type(value) is not list or len(value) != 2:
        raise ValueError("must be two vertices")
    first, second = (_vertex(name, v) for v in value)
    return first, second


def or_null(check: Check) -> Check:
    """What ``check`` lets through, or null."""
    return lambda name, value: None if value is None else check(name, value)


_vertex = whole(0, 2**31 - 1)
_halfedge = whole(0, 2**31 - 1)

WORDS: dict[str, dict[str, Check]] = {
    "hello": {},
    "hover": {"halfedge": whole(-1, 2**31 - 1), "operation": or_null(text)},
    "operate": {"operation": text, "halfedge": _halfedge, "ends": pair},
    "undo": {},
    "redo": {},
    "smooth": {},
    "untangle": {},
    "clean_all": {},
    "go_to": {"cursor": whole(0)},
    "auto_smooth": {"on": boolean},
    "desired": {"vertex": _vertex, "degree": whole(*DEGREES)},
    "lock": {"vertex": _vertex, "on": boolean},
    "corner": {"vertex": _vertex, "on": boolean},
    "agent": {"action": one_of("step", "play", "pause", "complete", "stop", "hint")},
    "speed": {"value": finite(0.0, 1e6)},
    "policy": {"name": text},
    "take_hint": {"index": whole(0, 1000)},
    "level": {"action": one_of("again", "next", "open", "solve"), "name?": text},
}
"""The fields of every word; a name that ends in ``?`` may be missing."""

FEW = 16
"""Fields of a message, at most."""


def parse(content: Any, buffers: Sequence[Any] | None = None) -> Request:
    """The request in a message's ``content``; raises RefusedError, saying what is wrong."""
    if type(content) is not dict:
        raise RefusedError("A message must be an object with a word in 'do'.")
    if len(content) > FEW or any(type(name) is not str for name in content):
        raise RefusedError("A message has too many fields, or fields without a name.")
    number, view = content.get("id"), content.get("view")
    if type(number) is not int or not 0 <= number <= LARGEST:
        raise RefusedError("A message must have a whole number from 0 as its 'id'.")
    if type(view) is not str or not 0 < len(view) <= LONGEST:
        raise RefusedError("A message must name its 'view'.", Request("", number, "", {}))
    do = content.get("do")
    asked = Request(do if type(do) is str and do in WORDS else "", number, view, {})
    if not asked.do:
        said = f" '{do}'" if type(do) is str and len(do) <= 40 and do.isprintable() else " that"
        raise RefusedError(f"There is nothing called{said} to do.", asked)
    if buffers:
        raise RefusedError(f"'{do}' takes no arrays.", asked)
    return Request(asked.do, number, view, _fields(asked, content))


def _fields(asked: Request, content: dict[str, Any]) -> dict[str, Any]:
    checks = WORDS[asked.do]
    known = {name.removesuffix("?") for name in checks} | {"do", "id", "view"}
    for name in content:
        if name not in known:
            shown = name if len(name) <= 40 and name.isprintable() else "that"
            raise RefusedError(f"'{asked.do}' has no field '{shown}'.", asked)
    fields = {}
    for field, check in checks.items():
        name = field.removesuffix("?")
        if name not in content:
            if name == field:
                raise RefusedError(f"'{asked.do}' needs the field '{name}'.", asked)
            continue
        try:
            fields[name] = check(name, content[name])
        except ValueError as error:
            raise RefusedError(f"'{asked.do}': '{name}' {error}.", asked) from None
    return fields
