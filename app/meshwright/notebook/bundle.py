"""The browser side of the widget: joins the files of ``front/`` into one ES module and one style.

The files are plain: top-level functions and classes, no import, no export. They share one scope, so
a name may be declared once only. Joining them is all there is of a build. The colours are those of
:mod:`meshwright.graphics.theme`, as CSS variables; the scripts read them from there, too.
"""

import json
from dataclasses import fields
from functools import cache
from pathlib import Path

from meshwright.graphics.icon_paths import STROKES
from meshwright.graphics.theme import FONTS, GRID, THEMES, Theme

FOLDER = Path(__file__).parent / "front"
SCRIPTS = (
    "dom.js",
    "link/host_theme.js",
    "mesh/mesh_replica.js",
    "link/kernel_link.js",
    "link/recording_link.js",
    "canvas/viewport.js",
    "mesh/derived.js",
    "mesh/spatial_grid.js",
    "mesh/picking.js",
    "mesh/mesh_state.js",
    "canvas/colours.js",
    "canvas/markers.js",
    "canvas/inverted_elements.js",
    "canvas/mesh_painter.js",
    "canvas/ghost.js",
    "canvas/hint_badges.js",
    "canvas/overlay.js",
    "canvas/stage.js",
    "canvas/zoom_buttons.js",
    "panels/labels.js",
    "input/hover.js",
    "panels/popup.js",
    "panels/menus.js",
    "input/pointer.js",
    "input/keyboard_navigation.js",
    "input/shortcuts.js",
    "panels/score_panel.js",
    "panels/operations_panel.js",
    "panels/agent_panel.js",
    "panels/notice.js",
    "mesh/score_series.js",
    "panels/score_curve.js",
    "panels/timeline.js",
    "panels/level_bar.js",
    "card.js",
    "index.js",
)
"""The files of the module in the order in which they are joined."""
STYLES = (
    "styles/card.css",
    "styles/panel.css",
    "styles/popups.css",
    "styles/timeline.css",
    "styles/levels.css",
)
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
    """The CSS variable of a colour of :class:`meshwright.graphics.theme.Theme`:
    ``--mw-accent-soft``.
    """
    return f"--mw-{name.replace('_', '-')}"


def _there(name: str) -> bool:
    return (FOLDER / name).is_file()


def _read(name: str) -> str:
    return (FOLDER / name).read_text(encoding="utf-8")
