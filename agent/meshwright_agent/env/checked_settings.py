"""Dataclasses of settings built from plain values, as TOML and JSON hold them, with checks.

Types and ranges come from the annotations of the dataclass. Keys that it does not have are refused,
so that a misspelt setting does not silently keep its default.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import fields, is_dataclass
from difflib import get_close_matches
from typing import Annotated, Any, TypeVar, get_type_hints

import msgspec
from msgspec import Meta

T = TypeVar("T")

PositiveInt = Annotated[int, Meta(ge=1)]
NonNegativeInt = Annotated[int, Meta(ge=0)]
PositiveFloat = Annotated[float, Meta(gt=0.0)]
NonNegativeFloat = Annotated[float, Meta(ge=0.0)]
AnyFloat = Annotated[float, Meta(ge=-1e6, le=1e6)]
"""A finite number of a size that arithmetic in single precision can bear."""
Fraction = Annotated[float, Meta(ge=0.0, le=1.0)]
"""From 0 to 1, both included."""

_TYPE_WORDS = {
    "int": "a whole number",
    "float": "a number",
    "str": "text",
    "bool": "true or false",
    "array": "a list",
    "object": "a section of settings",
}
_BOUND_WORDS = {">=": "at least", ">": "above", "<=": "at most", "<": "below"}
_AT = re.compile(r"^(?P<problem>.*?)(?: - at `\$\.?(?P<key>.*)`)?$", re.DOTALL)
_BOUND = re.compile(r"Expected `(?P<type>\w+)` (?P<sign>[<>]=?) (?P<bound>\S+)$")
_LENGTH = re.compile(r"Expected `array` of length (?P<length>\d+)")
_TYPE = re.compile(r"Expected `(?P<type>\w+)`")
_MISSING = re.compile(r"Object missing required field `(?P<name>.*)`")


class SettingsError(ValueError):
    """Settings that cannot be used; the message is one sentence that names the setting."""


def settings_from(values: Mapping[str, Any], to: type[T]) -> T:
    """The dataclass `to` from plain values, nested dataclasses included.

    Raises SettingsError with one sentence for an unknown or missing key, a value of the wrong type
    or out of range, and for what ``__post_init__`` of a dataclass refuses by ValueError; such a
    message must begin with the name of the setting.
    """
    if not isinstance(values, Mapping):
        raise SettingsError(f"settings must be a table of keys and values, not {_shown(values)}")
    _refuse_unknown(values, to, "")
    try:
        return msgspec.convert(values, to)
    except msgspec.ValidationError as error:
        raise SettingsError(_sentence(str(error), values)) from None


def _refuse_unknown(values: Mapping[str, Any], to: type, section: str) -> None:
    hints = get_type_hints(to)
    names = [field.name for field in fields(to)]
    for key, value in values.items():
        if key not in names:
            close = get_close_matches(str(key), names, 1)
            hint = f'; did you mean "{section}{close[0]}"?' if close else ""
            raise SettingsError(f'there is no setting "{section}{key}"{hint}')
        if is_dataclass(hints[key]) and isinstance(value, Mapping):
            _refuse_unknown(value, hints[key], f"{section}{key}.")


def _sentence(message: str, values: Mapping[str, Any]) -> str:
    """An error message of msgspec, in words and with the value that it is about."""
    found = _AT.match(message)
    assert found is not None
    problem, key = found["problem"], found["key"] or ""
    if missing := _MISSING.match(problem):
        return f'the setting "{key}{"." * bool(key)}{missing["name"]}" is missing'
    if bound := _BOUND.match(problem):
        limit = f"{float(bound['bound']):g}"
        wanted = f"{_TYPE_WORDS[bound['type']]} {_BOUND_WORDS[bound['sign']]} {limit}"
        wanted = wanted.replace("number at", "number of at")
    elif length := _LENGTH.match(problem):
        wanted = f"a list of {length['length']} values"
    elif expected := _TYPE.match(problem):
        wanted = _TYPE_WORDS.get(expected["type"], expected["type"])
    else:
        return f"{key}.{problem}" if key else problem
    return f"{key} must be {wanted}, not {_shown(_value_at(values, key))}"


def _value_at(values: Any, key: str) -> Any:
    """The value at a key such as ``ppo.horizon`` or ``sides[0]``."""
    for name, place in re.findall(r"(\w+)|\[(\d+)\]", key):
        values = values[name] if name else values[int(place)]
    return values


def _shown(value: Any) -> str:
    """A value as TOML writes it, cut where it is long."""
    if isinstance(value, bool):
        return str(value).lower()
    text = f'"{value}"' if isinstance(value, str) else str(value)
    return text if len(text) <= 60 else f"{text[:57]}..."
