"""The browser side of the widget as texts: one ES module and one style sheet.

The scripts are the ES modules of ``front/``, joined by :mod:`meshwright.notebook.build_bundle` into
one committed file. The style sheet is joined here, because the colours come from
:mod:`meshwright.graphics.theme`: they are CSS variables, which the scripts read as well.
"""

from dataclasses import fields
from functools import cache
from pathlib import Path

from meshwright.graphics.theme import FONTS, GRID, THEMES, Theme

FOLDER = Path(__file__).parent / "front"
BUNDLE = FOLDER / "generated" / "bundle.js"
GLOBAL = "meshwright"
"""The variable that the bundle defines: an object with the functions that ``index.js`` exports."""
STYLES = (
    "styles/card.css",
    "styles/panel.css",
    "styles/popups.css",
    "styles/timeline.css",
    "styles/levels.css",
)
"""The files of the style sheet in the order in which they are joined."""
ROOT = "meshwright"
"""The class of the widget's element, below which every rule of the style sheet applies."""


@cache
def module() -> str:
    """The ES module for anywidget: ``render({model, el})`` shows one view and returns a function
    that removes it.
    """
    return f"{script()}export default {{ render: {GLOBAL}.render }};\n"


@cache
def script() -> str:
    """The bundle as a classic script, which defines :data:`GLOBAL`."""
    return BUNDLE.read_text(encoding="utf-8")


@cache
def style() -> str:
    """The style sheet: variables of both themes, then the rules."""
    parts = [variables(theme) for theme in THEMES.values()]
    parts += [f"/* {name} */\n{(FOLDER / name).read_text(encoding='utf-8')}\n" for name in STYLES]
    return "\n".join(parts)


def variables(theme: Theme) -> str:
    """The rule that defines the colours of this theme."""
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
