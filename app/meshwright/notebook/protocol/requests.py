"""Messages from the browser: one struct for each word, validated by msgspec.

A message is the object ``{"do": word, "id": int, "view": str, ...}``; :data:`AnyRequest` is the
union of all structs, tagged by ``do``. Unknown words, unknown fields, missing fields and values out
of range are refused with one sentence before any other code sees the message.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import Annotated, Any, Literal, TypeAlias, get_args

import msgspec
from msgspec import UNSET, Meta, Struct, UnsetType

LONGEST = 200
"""Characters of a string, at most."""
LARGEST = 2**53 - 1
"""The largest integer that JavaScript represents exactly."""
LARGEST_ID = 2**31 - 1
"""The largest id of a vertex or a half-edge."""
DEGREES = 1, 100
"""Bounds of the desired degree of a vertex."""
SHOWN = 80
"""Characters of a reason that are shown; it may quote a long value."""
MOST_FIELDS = 16
"""Fields of a message, at most."""

Text: TypeAlias = Annotated[str, Meta(max_length=LONGEST)]
Count: TypeAlias = Annotated[int, Meta(ge=0, le=LARGEST)]
Id: TypeAlias = Annotated[int, Meta(ge=0, le=LARGEST_ID)]
IdOrNone: TypeAlias = Annotated[int, Meta(ge=-1, le=LARGEST_ID)]


class Envelope(Struct, frozen=True, kw_only=True):
    """What every message has, and what an answer needs: its number, and the view that sent it."""

    id: Count
    view: Annotated[str, Meta(min_length=1, max_length=LONGEST)]


class Request(Envelope, frozen=True, kw_only=True, forbid_unknown_fields=True, tag_field="do"):
    """A well-formed message; each subclass is one word."""

    @property
    def word(self) -> str:
        """The value of the field ``do``."""
        return word_of(type(self))


class Hello(Request, frozen=True, tag="hello"):
    """A new view requests the whole state."""


class Hover(Request, frozen=True, tag="hover"):
    """The pointer is over a half-edge, -1 for none; requests a preview of an operation there, by
    default of the best one.

    ``tolerance`` is how far the preview of a curved edge may lie off it, in the browser's frame.
    """

    halfedge: IdOrNone
    operation: Text | None
    tolerance: Annotated[float, Meta(gt=0.0, le=1.0)] | UnsetType = UNSET


class Still(Request, frozen=True, tag="still"):
    """Send the static picture for the saved notebook, now and after each change."""


class Operate(Request, frozen=True, tag="operate"):
    """Apply an operation; ``ends`` are the half-edge's vertices in the browser's copy."""

    operation: Text
    halfedge: Id
    ends: tuple[Id, Id]


class Undo(Request, frozen=True, tag="undo"):
    """Undo the last step."""


class Redo(Request, frozen=True, tag="redo"):
    """Redo the step that was undone last."""


class Smooth(Request, frozen=True, tag="smooth"):
    """Smooth the whole mesh."""


class Untangle(Request, frozen=True, tag="untangle"):
    """Repair inverted elements."""


class CleanAll(Request, frozen=True, tag="clean_all"):
    """Remove all removable global lines of a quad mesh."""


class GoTo(Request, frozen=True, tag="go_to"):
    """Go to a state of the history."""

    cursor: Count


class AutoSmooth(Request, frozen=True, tag="auto_smooth"):
    """Switch smoothing after every operation on or off."""

    on: bool


class Desired(Request, frozen=True, tag="desired"):
    """Set the desired degree of a vertex."""

    vertex: Id
    degree: Annotated[int, Meta(ge=DEGREES[0], le=DEGREES[1])]


class Lock(Request, frozen=True, tag="lock"):
    """Lock or unlock a vertex."""

    vertex: Id
    on: bool


class Pin(Request, frozen=True, tag="pin"):
    """Pin a vertex, so that smoothing keeps it in place, or free it."""

    vertex: Id
    on: bool


class Corner(Request, frozen=True, tag="corner"):
    """Make a vertex a corner, or not."""

    vertex: Id
    on: bool


class Agent(Request, frozen=True, tag="agent"):
    """Start, pause or stop the agent, skip the way to a result, or ask for hints.

    ``prefer`` is what a search prefers at s*, ``keep_size`` whether elements keep their size.
    """

    action: Literal["step", "play", "pause", "complete", "stop", "skip", "hint"]
    prefer: Literal["blocks", "balanced", "shape"] | UnsetType = UNSET
    keep_size: bool | UnsetType = UNSET


class Speed(Request, frozen=True, tag="speed"):
    """Set the agent's speed in decisions per second."""

    value: Annotated[float, Meta(ge=0.0, le=1e6)]


class ChoosePolicy(Request, frozen=True, tag="policy"):
    """Choose one of the policies on offer."""

    name: Text


class TakeHint(Request, frozen=True, tag="take_hint"):
    """Apply the hint of this index."""

    index: Annotated[int, Meta(ge=0, le=1000)]


class ShowBlocks(Request, frozen=True, tag="blocks"):
    """Send the blocks of the present state with their numbers of cells."""


class ChordCount(Request, frozen=True, tag="chord_count"):
    """Set the number of cells across the chord of a block edge, None: by size and evenness.

    ``ends`` are the vertices of the edge.
    """

    ends: tuple[Id, Id]
    count: Annotated[int, Meta(ge=1, le=100_000)] | None


class ExportBlocks(Request, frozen=True, tag="export_blocks"):
    """Make the fine grid, and send it as a file with this ending."""

    ending: Text


class ChangeLevel(Request, frozen=True, tag="level"):
    """Restart a level, go to another one, or let the agent solve it."""

    action: Literal["again", "next", "open", "solve"]
    name: Text | UnsetType = UNSET


AnyRequest: TypeAlias = (
    Hello
    | Hover
    | Still
    | Operate
    | Undo
    | Redo
    | Smooth
    | Untangle
    | CleanAll
    | GoTo
    | AutoSmooth
    | Desired
    | Lock
    | Pin
    | Corner
    | Agent
    | Speed
    | ChoosePolicy
    | TakeHint
    | ShowBlocks
    | ChordCount
    | ExportBlocks
    | ChangeLevel
)


def word_of(kind: type[Request]) -> str:
    """The value of the field ``do`` for messages of this type."""
    return str(kind.__struct_config__.tag)


WORDS: dict[str, type[Request]] = {word_of(kind): kind for kind in get_args(AnyRequest)}
"""The type of message for each word."""


class RefusedError(Exception):
    """A message is malformed; ``sentence`` gives the reason for the reader of the notebook."""

    def __init__(self, sentence: str, sender: Envelope | None = None) -> None:
        super().__init__(sentence)
        self.sentence = sentence
        self.sender = sender
        """The message to answer and its view; None where these are malformed themselves."""


def parse(content: Any, buffers: Sequence[Any] | None = None) -> AnyRequest:
    """The request in a message's ``content``.

    Raises:
        RefusedError: one sentence on what is malformed.
    """
    if type(content) is not dict:
        raise RefusedError("A message must be an object with a word in 'do'.")
    if len(content) > MOST_FIELDS or any(type(name) is not str for name in content):
        raise RefusedError("A message has too many fields, or fields without a name.")
    try:
        sender = msgspec.convert(content, Envelope)
    except msgspec.ValidationError as error:
        raise RefusedError(f"Malformed message: {_reason(error)}.") from None
    word = content.get("do")
    if type(word) is not str or word not in WORDS:
        raise RefusedError(f"Unknown request{_shown(word)}.", sender)
    if buffers:
        raise RefusedError(f"'{word}' takes no arrays.", sender)
    try:
        request: AnyRequest = msgspec.convert(content, AnyRequest)
    except msgspec.ValidationError as error:
        raise RefusedError(f"Malformed '{word}': {_reason(error)}.", sender) from None
    return request


def _reason(error: msgspec.ValidationError) -> str:
    """msgspec's message as a part of a sentence: ``expected 'int', got 'str' at 'halfedge'``."""
    what, _, path = str(error).partition(" - at `$.")
    what = "".join(c if c.isprintable() else "\ufffd" for c in what[:SHOWN]).replace("`", "'")
    if len(what) == SHOWN:
        what += "\u2026"
    field = re.match(r"\w{1,40}", path)
    at = f" at '{field[0]}'" if field else ""
    return what[:1].lower() + what[1:] + at


def _shown(word: Any) -> str:
    short = type(word) is str and len(word) <= 40 and word.isprintable()
    return f" '{word}'" if short else ""
