"""Exports the recording of a history as one HTML page that needs no Python.

The file is self-contained: it loads nothing from a network, works from a disk and in a sandboxed
frame. Its Content Security Policy allows its own script only.
"""

from __future__ import annotations

import json
import os
from base64 import b64encode
from hashlib import sha256
from html import escape
from typing import Any

from meshwright.document.document import Document
from meshwright.graphics.mesh_figure import elements
from meshwright.graphics.theme import DARK, LIGHT, Theme
from meshwright.notebook import bundle
from meshwright.notebook.export.recording import record
from meshwright_core.io import atomic_write

LONGEST = 200
"""Characters of a title."""


def page(document: Document, title: str = "", path: str | os.PathLike[str] | None = None) -> str:
    """The page of ``document`` as text; also written to ``path``.

    The default title is the document's name. The page starts in the present state. Raises
    MeshError where there is no mesh or ``path`` cannot be written; an existing file is unchanged
    then.
    """
    recording, mesh = record(document), document.mesh
    heading = _heading(title or document.name or (elements(mesh) if mesh is not None else ""))
    text = _html(heading, _note(recording), recording)
    if path is not None:
        with atomic_write.replacing(path) as temporary:
            temporary.write_text(text, encoding="utf-8", newline="\n")
    return text


def _html(heading: str, note: str, recording: dict[str, Any]) -> str:
    script = _script()
    return f"""<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta http-equiv="Content-Security-Policy" content="{_policy(script)}">
<meta name="generator" content="Meshwright">
<title>{escape(heading)}</title>
<style>
{_page_style()}
{bundle.style()}</style>
</head>
<body>
<main>
<h1>{escape(heading)}</h1>
<p>{escape(note)}</p>
<div id="film"></div>
<noscript><p>This recording needs JavaScript, which is disabled here.</p></noscript>
<p class="end">Made with Meshwright</p>
</main>
<script type="application/json" id="recording">{_embedded(recording)}</script>
<script>{script}</script>
</body>
</html>
"""


def _heading(title: str) -> str:
    """``title`` as one line of at most :data:`LONGEST` characters."""
    line = " ".join(title.split())
    return line if len(line) <= LONGEST else line[: LONGEST - 1] + "\u2026"


def _note(recording: dict[str, Any]) -> str:
    """One sentence on what the recording shows."""
    scores, optima = recording["track"]["scores"], recording["track"]["optima"]
    count = len(scores) - 1
    if count == 0:
        way = f"no steps, s {scores[0]:,}"
    else:
        steps = f"{count:,} step{'' if count == 1 else 's'}"
        way = f"{steps}, from s {scores[0]:,} to {scores[-1]:,}"
    return f"Recording of an edit: {way}, optimum {optima[-1]:,}. It cannot be edited."


def _embedded(recording: dict[str, Any]) -> str:
    """JSON that cannot close the script element around it, whatever names it contains."""
    text = json.dumps(recording, separators=(",", ":"), allow_nan=False)
    return text.replace("<", "\\u003c").replace(">", "\\u003e").replace("&", "\\u0026")


def _script() -> str:
    """The bundle, and the call that shows the embedded recording."""
    return f"{bundle.script()}{bundle.GLOBAL}.showRecording();\n"


def _policy(script: str) -> str:
    """The Content Security Policy: this one script, styles, and nothing from a network."""
    hashed = b64encode(sha256(script.encode()).digest()).decode("ascii")
    return (
        f"default-src 'none'; script-src 'sha256-{hashed}'; style-src 'unsafe-inline'; "
        "img-src data:; base-uri 'none'; form-action 'none'"
    )


def _page_style() -> str:
    """Style of the page around the widget, light or dark as the system."""
    return f"""{_colours(LIGHT)}
@media (prefers-color-scheme: dark) {{ {_colours(DARK)} }}
html {{ background: var(--page); color: var(--ink); }}
body {{ margin: 0; font: 14px/1.5 system-ui, sans-serif; }}
main {{ max-width: 1120px; margin: 0 auto; padding: 16px; }}
h1 {{ margin: 0; font-size: 20px; line-height: 1.3; overflow-wrap: anywhere; }}
p {{ margin: 4px 0 16px; color: var(--quiet); }}
p.end {{ margin: 8px 0 0; font-size: 12px; text-align: right; }}
@media print {{
main .meshwright {{ break-inside: avoid; print-color-adjust: exact; }}
main .mw-stage .mw-stage-tools, main .mw-select {{ display: none; }}
main .mw-timeline-row > :not(.mw-timeline-legend) {{ display: none; }}
}}"""


def _colours(theme: Theme) -> str:
    return (
        f":root {{ --page: {theme.background}; --ink: {theme.text}; --quiet: {theme.muted}; "
        f"color-scheme: {theme.name}; }}"
    )
