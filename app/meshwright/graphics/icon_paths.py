"""The icons as SVG paths of strokes on a grid of 20 by 20; each view sets their colour."""

STROKES = {
    "new": "M3 3h14v14H3z M10 3v14 M3 10h14",
    "open": "M2.5 15.5v-11h5l2 2.5h8v8.5z",
    "save": "M10 3v9 M6.5 9l3.5 3.5L13.5 9 M3.5 13v3.5h13V13",
    "undo": "M7 4L3.5 7.5 7 11 M3.5 7.5h8a4.5 4.5 0 0 1 0 9H7",
    "redo": "M13 4l3.5 3.5L13 11 M16.5 7.5h-8a4.5 4.5 0 0 0 0 9H13",
    "clean": "M3 3.5h14 M3 16.5h14 M3 10h2.5 M8.75 10h2.5 M14.5 10H17",
    "smooth": "M2.5 12.5c3-9 5.5-9 7.5-2.5s4.5 6.5 7.5-2.5",
    "fit": "M3 7V3h4 M13 3h4v4 M17 13v4h-4 M7 17H3v-4 M7.5 7.5h5v5h-5z",
    "theme": "M10 3a7 7 0 1 0 0 14a7 7 0 1 0 0-14z M10 3v14 M10 6.5h3.5 M10 10h4.5 M10 13.5h3.5",
    "step": "M6 4.5v11l7-5.5z M15.5 4.5v11",
    "play": "M6.5 4v12l9-6z",
    "pause": "M7 4.5v11 M13 4.5v11",
    "complete": "M3.5 5v10l6-5z M10.5 5v10l6-5z",
    "stop": "M5.5 5.5h9v9h-9z",
    "help": "M10 3a7 7 0 1 0 0 14a7 7 0 1 0 0-14z M8 8a2 2 0 1 1 2.8 1.85q-.8.35-.8 1.4 "
    "M10 13.6v.1",
    "first": "M5 4.5v11 M14.5 4.5v11L8 10z",
    "back": "M12.5 4.5L7 10l5.5 5.5",
    "forward": "M7.5 4.5L13 10l-5.5 5.5",
    "last": "M15 4.5v11 M5.5 4.5v11l6.5-5.5z",
    "film": "M3 4.5h14v11H3z M6.5 4.5v11 M13.5 4.5v11 M3 8.2h3.5 M3 11.8h3.5 M13.5 8.2H17 "
    "M13.5 11.8H17",
    "down": "M5 7.5l5 5 5-5",
    "right": "M7.5 5l5 5-5 5",
    "search": "M9 3.5a5.5 5.5 0 1 0 0 11a5.5 5.5 0 1 0 0-11z M13 13l4 4",
    "edit": "M5 3.5l10.5 6-4.7 1.2L8.6 15.5z M11 11l3.5 5",
    "box": "M3.5 6.5v-3h3 M9 3.5h2 M13.5 3.5h3v3 M16.5 9v2 M16.5 13.5v3h-3 "
    "M11 16.5H9 M6.5 16.5h-3v-3 M3.5 11V9",
    "lasso": "M10 3.5c4 0 6.5 2 6.5 4.5S14 12.5 10 12.5 3.5 10.5 3.5 8 6 3.5 10 3.5z M6.5 11.5"
    "c-2 .8-2 2.6-.2 2.6s2 1.6.7 2.6",
    "lines": "M3 3.5h14v13H3z M3 10h14 M7.5 8.2v3.6 M12.5 8.2v3.6",
    "alert": "M10 3L2.5 16.5h15z M10 8v4 M10 14.2v.1",
    "dice": "M3.5 3.5h13v13h-13z M7 7v.1 M13 7v.1 M10 10v.1 M7 13v.1 M13 13v.1",
    "check": "M4 10.5l4 4 8-9",
    "close": "M5.5 5.5l9 9 M14.5 5.5l-9 9",
}

WINDOW_STROKES = {
    "blocks": "M3 3.5h14v13H3z M3 9c5 0 9 2 14 2 M9 3.5c0 5-1 8 0 13",
}
"""Those that only the window has."""
