"""The browser side of the widget: joins the files of ``front/`` into one ES module and one style.

The files are plain: top-level functions and classes, no import, no export. They share one scope, so
a name may be declared once only. Joining them is all there is of a build. The colours are those of
:mod:`app.theme`, as CSS variables; the scripts read them from there, too.
"""

import json
from dataclasses import fields
from functools import cache
from pathlib import Path

from app.strokes import STROKES
from app.theme import FONTS, GRID, THEMES, Theme

FOLDER = Path(__file__).parent / "front"
SCRIPTS = (
    "node.js",
    "host.js",
    "mirror.js",
    "link.js",
    "film_link.js",
    "viewport.js",
    "facts.js",
    "grid.js",
    "picking.js",
    "work.js",
    "palette.js",
    "marks.js",
    "hatching.js",
    "picture.js",
    "ghost.js",
    "hint_badges.js",
    "overlay.js",
    "stage.js",
    "stage_tools.js",
    "words.js",
    "pointing.js",
    "popup.js",
    "menus.js",
    "pointer.js",
    "walking.js",
    "keys.js",
    "score_panel.js",
    "operations_panel.js",
    "agent_panel.js",
    "notice.js",
    "track.js",
    "track_paint.js",
    "timeline.js",
    "levels.js",
    "card.js",
    "main.js",
)
"""The files of the module in the order in which they are joined."""
STYLES = ("card.css", "panel.css", "popups.css", "timeline.css", "levels.css")
"""The files of the style, likewise."""
ROOT = "meshwright"
"""The class of the card, below which every rule of the style applies."""
EXPORT = "export default { render };\n"


@cache
def module() -> str:
    """The ES module: ``render({model, el})`` shows one view and returns its clean-up."""
    return script() + EXPORT


@cache
def script() -> str:
    """The module without its last line, for pages that bring their own link."""
    return constants() + "".join(f"// {name}\n{_read(name)}\n" for name in SCRIPTS if _there(name))


def constants() -> str:
    """What the scripts know from Python: names of the colours, and the icons."""
    names = [field.name for field in fields(Theme) if field.name != "name"]
    return (
        f"const PALETTE_NAMES = {json.dumps(names)};\n"
        f"const ICON_STROKES = {json.dumps(STROKES, indent=1)};\n"
    )


@cache
def style() -> str:
    """The style: variables of both themes, then the rules."""
    parts = [variables(theme) for theme in THEMES.values()]
    parts += [f"/* {name} */\n{_read(name)}\n" for name in STYLES if _there(name)]
    return "\n".join(parts)


def variables(theme: Theme) -> str:
    """The rule that gives a card of this theme its colours."""
    lines = [
        f"  {variable(field.name)}: {getattr(theme, field.name)};"
        for field in fields(theme)
        if field.name != "name"
    ]
    families = ", ".join(f'"{family}"' if " " in family else family for family in FONTS)
    lines += [
        f"  --mw-grid: {GRID}px;",
        f"  --mw-font: -apple-system, {families}, system-ui, sans-serif;",
        f"  color-scheme: {theme.name};",
    ]
    return f'.{ROOT}[data-theme="{theme.name}"] {{\n' + "\n".join(lines) + "\n}\n"


def variable(name: str) -> str:
    """The CSS variable of a colour of :class:`app.theme.Theme`: ``--mw-accent-soft``."""
    return f"--mw-{name.replace('_', '-')}"


def _there(name: str) -> bool:
    return (FOLDER / name).is_file()


def _read(name: str) -> str:
    return (FOLDER / name).read_text(encoding="utf-8")
