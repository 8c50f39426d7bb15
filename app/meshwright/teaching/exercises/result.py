"""The result of checking an answer, with its display in notebooks."""

from __future__ import annotations

import re
from dataclasses import dataclass
from html import escape
from typing import Any

from meshwright.graphics.theme import DARK, LIGHT, Theme

RIGHT, WRONG, BLANK = "right", "wrong", "blank"

MIME = "application/vnd.meshwright.answer+json"
"""The type of the result as JSON data, for programs that collect results from notebooks."""

_HEADS = {RIGHT: "Right.", WRONG: "Not yet.", BLANK: "Not answered yet."}
_SIGNS = {RIGHT: "\u2713", WRONG: "\u2717", BLANK: "\u2026"}
_MARKS = {
    RIGHT: '<path d="M5 10.4l3.4 3.4L15 7"/>',
    WRONG: '<path d="M10 5.5v5.4"/><path d="M10 14.2v.1"/>',
    BLANK: '<path d="M5.6 10h.1M10 10h.1M14.4 10h.1"/>',
}


@dataclass(frozen=True)
class Answer:
    """The result of checking an answer. ``state`` is ``"right"``, ``"wrong"`` or ``"blank"``;
    ``sentence`` explains why it is right, gives help, or is the hint of the exercise.
    """

    exercise: str
    state: str
    sentence: str

    @property
    def passed(self) -> bool:
        """Whether the answer is right."""
        return self.state == RIGHT

    def __bool__(self) -> bool:
        """Whether the answer is right."""
        return self.passed

    def __repr__(self) -> str:
        """A sign, the number of the exercise, the state and the sentence."""
        return f"{_SIGNS[self.state]} {self.exercise}  {_HEADS[self.state]} {self.sentence}"

    def _repr_html_(self) -> str:
        """One line in a box; its colours follow the theme of the notebook."""
        return (
            f"<style>{STYLE}</style>"
            f'<div class="mw-answer mw-{self.state}" role="status">'
            f'<svg viewBox="0 0 20 20" aria-hidden="true"><circle cx="10" cy="10" r="9"/>'
            f"{_MARKS[self.state]}</svg>"
            f"<div><b>{_HEADS[self.state]}</b> {_marked_up(self.sentence)}</div>"
            f"<span>{escape(self.exercise)}</span></div>"
        )

    def _repr_mimebundle_(self, include: Any = None, exclude: Any = None) -> dict[str, Any]:
        """Text, HTML, and data."""
        data = {"exercise": self.exercise, "state": self.state, "passed": self.passed}
        return {"text/plain": repr(self), "text/html": self._repr_html_(), MIME: data}


def _marked_up(sentence: str) -> str:
    """HTML of a sentence with `code` in backquotes; hyphens before numbers become minus signs."""
    parts = escape(sentence, quote=False).split("`")
    return "".join(
        f"<code>{part}</code>" if i % 2 else re.sub(r"(?<!\w)-(?=[\d ])", "\u2212", part)
        for i, part in enumerate(parts)
    )


def _variables(theme: Theme) -> str:
    return (
        f"--mw-text:{theme.text};--mw-muted:{theme.muted};--mw-line:{theme.line};"
        f"--mw-accent:{theme.accent};--mw-soft:{theme.accent_soft};--mw-on:{theme.accent_text};"
        f"--mw-warning:{theme.warning};--mw-code:{theme.hover};--mw-raised:{theme.raised}"
    )


DARK_HOSTS = '[data-jp-theme-light="false"]', ".vscode-dark", ".dark"
"""CSS selectors of JupyterLab, VS Code and marimo with a dark theme."""

STYLE = (
    f".mw-answer,.mw-code{{{_variables(LIGHT)}}}"
    + ",".join(f"{host} .mw-answer,{host} .mw-code" for host in DARK_HOSTS)
    + f"{{{_variables(DARK)}}}"
    ".mw-answer{display:flex;gap:8px;align-items:flex-start;max-width:720px;margin:4px 0;"
    "padding:8px 12px;border:1px solid var(--mw-line);border-radius:8px;color:var(--mw-text);"
    "background:var(--mw-raised);font:13px/20px system-ui,-apple-system,'Segoe UI',sans-serif}"
    ".mw-answer div{flex:1;min-width:0}"
    ".mw-answer span{color:var(--mw-muted);font-variant-numeric:tabular-nums}"
    ".mw-answer code{padding:0 4px;border-radius:4px;background:var(--mw-code);color:inherit;"
    "font-size:12px}"
    ".mw-answer svg{flex:none;width:20px;height:20px;fill:none;stroke-width:2;"
    "stroke-linecap:round;stroke-linejoin:round;stroke:var(--mw-muted)}"
    ".mw-answer circle{stroke:none}"
    ".mw-right{border-color:var(--mw-accent);background:var(--mw-soft)}"
    ".mw-right svg{stroke:var(--mw-on)}.mw-right circle{fill:var(--mw-accent)}"
    ".mw-wrong svg,.mw-blank svg{stroke-width:2.4}"
    ".mw-wrong b,.mw-wrong svg{color:var(--mw-warning);stroke:var(--mw-warning)}"
    ".mw-wrong circle{stroke:var(--mw-warning);stroke-width:1.4}"
    ".mw-blank circle{stroke:var(--mw-line);stroke-width:1.4}"
)
