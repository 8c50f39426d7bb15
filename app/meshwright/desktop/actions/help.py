"""Actions of the menu Help: palette, shortcuts, tour, About."""

from __future__ import annotations

from meshwright.desktop.actions.action import Action

ACTIONS: tuple[Action, ...] = (
    Action(
        "palette",
        "Find a command\u2026",
        "Search all commands by a few letters",
        run=lambda context: context.help.show_palette(),
        shortcuts=("Ctrl+K", "Ctrl+Shift+P"),
        menu="Help",
        icon="search",
        repeats=False,
    ),
    Action(
        "help",
        "Keyboard and mouse",
        "All keyboard shortcuts and mouse gestures",
        run=lambda context: context.help.show_keys(),
        shortcuts=("F1",),
        menu="Help",
        icon="help",
    ),
    Action(
        "menu_bar",
        "Menu bar",
        "Open the first menu; Alt and an underlined letter opens one of them",
        run=lambda context: context.open_menus(),
        shortcuts=("F10",),
        menu="Help",
    ),
    Action(
        "tour",
        "Show the tour",
        "Five steps around the window",
        run=lambda context: context.help.show_tour(),
        menu="Help",
    ),
    Action(
        "about",
        "About Meshwright",
        "Version and licences",
        run=lambda context: context.help.show_about(),
        menu="Help",
    ),
)
