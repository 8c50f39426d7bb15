"""The light and the dark theme: colours of meshes and controls, and the Qt style sheet.

Only irregular vertices have strong colours (vermilion and blue, which colour-blind people can tell
apart); controls have one accent colour. All distances are multiples of :data:`GRID`.
"""

from dataclasses import dataclass, replace
from pathlib import Path

import meshwright_assets

GRID = 8
"""Margins and gaps in pixels are multiples of this, or of half of it in small controls."""

FONTS = ("Inter", "Segoe UI", "SF Pro Text", "Helvetica Neue", "Noto Sans", "Nimbus Sans", "Arial")
"""Font families of the interface, in order of preference."""


@dataclass(frozen=True)
class Theme:
    """Colours as six hexadecimal digits; ``plus`` and ``minus`` are those of delta > 0 and < 0."""

    name: str
    background: str
    fill: str
    edge: str
    boundary: str
    plus: str
    minus: str
    marker_text: str
    corner: str
    arrow: str
    panel: str
    raised: str
    line: str
    text: str
    muted: str
    faint: str
    accent: str
    accent_hover: str
    accent_text: str
    accent_soft: str
    hover: str
    pressed: str
    warning: str
    warning_soft: str


LIGHT = Theme(
    name="light",
    background="#fafaf8",
    fill="#f1f2ed",
    edge="#8d99a6",
    boundary="#2f3b48",
    plus="#d55e00",
    minus="#0072b2",
    marker_text="#ffffff",
    corner="#2f3b48",
    arrow="#0f766e",
    panel="#f3f3ef",
    raised="#ffffff",
    line="#deded7",
    text="#1e2329",
    muted="#5d656e",
    faint="#9aa1a8",
    accent="#0f766e",
    accent_hover="#0c635c",
    accent_text="#ffffff",
    accent_soft="#dcebe8",
    hover="#e8e8e2",
    pressed="#dcdcd5",
    warning="#8a5a00",
    warning_soft="#fbf1d9",
)

DARK = Theme(
    name="dark",
    background="#121416",
    fill="#1b1f23",
    edge="#596572",
    boundary="#c3ccd5",
    plus="#d55e00",
    minus="#0072b2",
    marker_text="#ffffff",
    corner="#c3ccd5",
    arrow="#4cc2b4",
    panel="#1a1d20",
    raised="#23272b",
    line="#31363b",
    text="#e8eaec",
    muted="#a0a8b0",
    faint="#6c747c",
    accent="#3fb3a6",
    accent_hover="#56c4b7",
    accent_text="#0b1413",
    accent_soft="#1d3a38",
    hover="#2a2f34",
    pressed="#343a40",
    warning="#e8b750",
    warning_soft="#352c17",
)

THEMES = {theme.name: theme for theme in (LIGHT, DARK)}

COLOURS = {
    "vermilion": ("Vermilion and blue", "#d55e00", "#0072b2"),
    "gold": ("Gold and violet", "#a66f00", "#8a63d2"),
    "strong": ("Red and navy, stronger", "#b3261e", "#1f4fa3"),
}
"""Name and pair of colours for delta > 0 and < 0. In each pair one colour is warm and one is cold,
which colour-blind people can tell apart, and white numbers are legible on both.
"""


def theme(name: str, colours: str = "vermilion") -> Theme:
    """The theme called ``name``, ``"light"`` or ``"dark"``, with one of :data:`COLOURS`."""
    if name not in THEMES:
        raise ValueError(f"There is no theme '{name}'; choose one of {', '.join(THEMES)}.")
    _, plus, minus = COLOURS[colours]
    return replace(THEMES[name], plus=plus, minus=minus)


REGION_HUES = ("#c58b2a", "#3f78c9", "#4c9a57", "#9560b8", "#bf5670")
"""Fills of regions are mixed with these hues, in turn."""
REGION_SHARE = 0.14
"""Share of the hue in a region's fill: enough to tell neighbours apart, light enough for marks."""


NAME_HUES = ("#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#8c6bb1", "#7a7f2a", "#b5651d", "#3a8f98")
"""Colours of named sides, in turn; those of irregular vertices are not among them."""


SWATCH_SHARE = 0.55
"""The same in the small squares beside names of regions."""


def region_fills(theme: Theme, count: int) -> list[str]:
    """The fill of each region of a mesh; the plain fill if there is only one."""
    return _region_colours(theme, count, REGION_SHARE)


def name_colours(theme: Theme, count: int) -> list[str]:
    """The colours of so many named sides: a hue each, in turns that grow paler."""
    colours = []
    for i in range(count):
        turn, hue = divmod(i, len(NAME_HUES))
        colours.append(_mixed(NAME_HUES[hue], theme.background, min(0.6, 0.3 * turn)))
    return colours


def region_swatches(theme: Theme, count: int) -> list[str]:
    """The colours of the same regions where they cover a few pixels only."""
    return _region_colours(theme, count, SWATCH_SHARE)


def _region_colours(theme: Theme, count: int, share: float) -> list[str]:
    if count < 2:
        return [theme.fill] * count
    hues = (REGION_HUES[i % len(REGION_HUES)] for i in range(count))
    return [_mixed(theme.fill, hue, share) for hue in hues]


def _mixed(one: str, other: str, share: float) -> str:
    """A colour ``share`` of the way from one to another, which has six hexadecimal digits; a mix
    for the browser if the first is a CSS variable.
    """
    if not one.startswith("#"):
        return f"color-mix(in srgb,{other} {share:.0%},{one})"
    a, b = bytes.fromhex(one[1:]), bytes.fromhex(other[1:])
    return "#" + bytes(round(x + share * (y - x)) for x, y in zip(a, b, strict=True)).hex()


def style_sheet(theme: Theme) -> str:
    """The Qt style sheet of the whole window."""
    t, icons = theme, (Path(meshwright_assets.__file__).parent / "icons").as_posix()
    return f"""
* {{ color: {t.text}; font-size: 13px; outline: 0; }}
QMainWindow, QDialog {{ background: {t.panel}; }}
QToolTip {{ background: {t.text}; color: {t.panel}; border: 0; padding: 4px 8px; }}

QMenuBar {{ background: {t.panel}; padding: 2px 8px; }}
QMenuBar::item {{ padding: 4px 8px; border-radius: 4px; background: transparent; }}
QMenuBar::item:selected {{ background: {t.hover}; }}
QMenu {{ background: {t.raised}; border: 1px solid {t.line}; padding: 4px; }}
QMenu::item {{ padding: 6px 24px 6px 12px; border-radius: 4px; }}
QMenu::item:selected {{ background: {t.accent_soft}; }}
QMenu::item:disabled {{ color: {t.faint}; }}
QMenu::separator {{ height: 1px; background: {t.line}; margin: 4px 8px; }}

QToolBar {{ background: {t.panel}; border: 0; border-bottom: 1px solid {t.line};
           padding: 4px 8px; spacing: 2px; }}
QToolBar::separator {{ width: 1px; background: {t.line}; margin: 6px 6px; }}
QToolButton {{ border: 0; border-radius: 6px; padding: 6px 8px; background: transparent; }}
QToolButton:hover {{ background: {t.hover}; }}
QToolButton:pressed {{ background: {t.pressed}; }}
QToolButton:checked {{ background: {t.accent_soft}; }}
QToolButton:disabled {{ color: {t.faint}; }}

#Sidebar, #SidebarBody {{ background: {t.panel}; border: 0; }}
#Sidebar {{ border-left: 1px solid {t.line}; }}
#Heading {{ color: {t.muted}; font-size: 11px; font-weight: 600; letter-spacing: 1px; }}
#Rule {{ background: {t.line}; border: 0; }}
#Big {{ font-size: 40px; font-weight: 600; }}
#Label, #Hint {{ color: {t.muted}; }}
#Hint {{ font-size: 12px; }}
#Value {{ font-weight: 600; }}
#Optimal {{ background: {t.accent_soft}; border-radius: 8px; }}
#OptimalTitle {{ color: {t.accent}; font-weight: 600; }}
#OptimalText {{ color: {t.text}; font-size: 12px; }}
#Optimal[warns="true"] {{ background: {t.warning_soft}; }}
#OptimalTitle[warns="true"], #OptimalText[warns="true"] {{ color: {t.warning}; }}
#Operation {{ font-size: 12px; }}
#Operation:disabled, #Key:disabled, #RowTitle:disabled {{ color: {t.faint}; }}
#Reason {{ color: {t.muted}; font-size: 11px; }}
#Row {{ border-radius: 4px; }}
#Row[current="true"] {{ background: {t.accent_soft}; }}
#Key {{ background: {t.raised}; border: 1px solid {t.line}; border-radius: 4px;
       padding: 1px 6px; font-size: 11px; color: {t.muted}; }}

QPushButton {{ background: {t.raised}; border: 1px solid {t.line}; border-radius: 6px;
              padding: 7px 12px; }}
QPushButton:hover {{ background: {t.hover}; }}
QPushButton:pressed {{ background: {t.pressed}; }}
QPushButton:focus {{ border-color: {t.accent}; }}
QPushButton:disabled {{ color: {t.faint}; background: transparent; }}
QPushButton#Primary {{ background: {t.accent}; color: {t.accent_text}; border-color: {t.accent};
                      font-weight: 600; }}
QPushButton#Primary:hover {{ background: {t.accent_hover}; border-color: {t.accent_hover}; }}
QPushButton#Primary:disabled {{ background: {t.pressed}; border-color: {t.pressed};
                               color: {t.faint}; }}
QPushButton#HintRow {{ border-radius: 4px; padding: 0; }}
QPushButton#HintRow:hover, QPushButton#HintRow:focus {{ background: {t.accent_soft}; }}
QPushButton#Link {{ background: transparent; border: 0; color: {t.accent}; padding: 4px; }}
QPushButton#Fold {{ background: transparent; border: 0; padding: 2px 6px 2px 0; text-align: left;
                   color: {t.muted}; font-size: 11px; font-weight: 600; letter-spacing: 1px; }}
QPushButton#Fold:hover {{ color: {t.text}; }}
QPushButton#Fold:focus {{ color: {t.accent}; }}
QPushButton#Chip {{ background: transparent; border: 0; border-radius: 4px; padding: 2px 6px;
                   font-size: 11px; color: {t.muted}; }}
QPushButton#Chip:hover {{ background: {t.hover}; }}
QPushButton#Chip:checked {{ background: {t.accent_soft}; color: {t.accent}; }}
QPushButton#Chip:focus {{ border: 1px solid {t.accent}; padding: 1px 5px; }}
QPushButton#ValueLink {{ background: transparent; border: 0; padding: 0; font-weight: 600;
                        color: {t.accent}; text-decoration: underline; }}
QPushButton#ValueLink:hover {{ color: {t.accent_hover}; }}
QPushButton#ValueLink:disabled {{ color: {t.text}; text-decoration: none; }}
QPushButton#ValueLink[warns="true"] {{ color: {t.warning}; }}
#Palette {{ background: {t.raised}; border: 1px solid {t.line}; border-radius: 10px; }}
#PaletteField {{ background: {t.background}; font-size: 15px; padding: 8px 12px; }}
#PaletteField:focus {{ border-color: {t.accent}; }}
#PaletteList {{ background: transparent; border: 0; padding: 0; }}
#PaletteList::item, #PaletteList::item:hover, #PaletteList::item:selected {{
    background: transparent; padding: 0; }}
#CalloutTitle {{ font-size: 16px; font-weight: 600; }}
#CalloutDone {{ color: {t.accent}; font-weight: 600; }}
#Table {{ background: {t.background}; border: 1px solid {t.line}; border-radius: 6px;
         selection-background-color: {t.accent_soft}; selection-color: {t.text}; }}
#Table::item {{ padding: 2px 8px; }}
QHeaderView, QHeaderView::section {{ background: {t.panel}; color: {t.muted}; border: 0;
                                    font-size: 12px; }}
QHeaderView::section {{ padding: 4px 12px; }}
#LicenceText {{ background: {t.background}; border: 1px solid {t.line}; border-radius: 6px;
               padding: 4px; font-family: monospace; font-size: 12px; }}
QCheckBox {{ spacing: 8px; }}
QCheckBox:disabled {{ color: {t.faint}; }}
QCheckBox::indicator, #Table::indicator {{ width: 16px; height: 16px; border-radius: 4px;
                       border: 1px solid {t.faint}; background: {t.raised}; }}
QCheckBox::indicator:checked, #Table::indicator:checked {{
    background: {t.accent}; border-color: {t.accent}; image: url({icons}/check-{t.name}.svg); }}
QCheckBox::indicator:disabled {{ border-color: {t.line}; background: transparent; }}
QCheckBox::indicator:checked:disabled {{ background: {t.faint}; }}
QCheckBox::indicator:hover, QCheckBox:focus::indicator {{ border-color: {t.accent}; }}
QPushButton#Segment {{ border-radius: 0; padding: 6px 16px; }}
QPushButton#Segment:checked {{ background: {t.accent_soft}; border-color: {t.accent};
                              color: {t.accent}; font-weight: 600; }}

QComboBox {{ background: {t.raised}; border: 1px solid {t.line}; border-radius: 6px;
            padding: 6px 10px; }}
QComboBox:focus {{ border-color: {t.accent}; }}
QComboBox:disabled {{ color: {t.faint}; }}
QComboBox::drop-down {{ border: 0; width: 24px; }}
QComboBox::down-arrow {{ image: url({icons}/down-{t.name}.svg); width: 14px; height: 14px; }}
QComboBox QAbstractItemView {{ background: {t.raised}; border: 1px solid {t.line}; padding: 4px;
    selection-background-color: {t.accent_soft}; selection-color: {t.text}; }}
QSlider {{ min-height: 20px; }}
QSlider::groove:horizontal {{ height: 4px; border-radius: 2px; background: {t.pressed}; }}
QSlider::sub-page:horizontal {{ height: 4px; border-radius: 2px; background: {t.accent}; }}
QSlider::handle:horizontal {{ width: 14px; height: 14px; margin: -5px 0; border-radius: 7px;
    background: {t.accent}; }}
QSlider::handle:horizontal:hover {{ background: {t.accent_hover}; }}
QSlider::sub-page:horizontal:disabled, QSlider::handle:horizontal:disabled {{
    background: {t.faint}; }}

QStatusBar {{ background: {t.panel}; border-top: 1px solid {t.line}; min-height: 28px; }}
QStatusBar::item {{ border: 0; }}
QStatusBar QLabel {{ color: {t.muted}; font-size: 12px; padding: 0 8px; }}
#Notice {{ background: {t.warning_soft}; border: 0; border-bottom: 1px solid {t.line}; }}
#NoticeText {{ color: {t.warning}; }}
#NoticeClose {{ color: {t.warning}; padding: 2px 8px; }}

#OperationMenu {{ background: {t.raised}; border: 1px solid {t.line}; border-radius: 8px; }}
#Empty {{ background: {t.background}; }}
#Question {{ font-size: 15px; font-weight: 600; }}
#CardList {{ background: {t.panel}; }}
#Card {{ background: {t.raised}; border: 1px solid {t.line}; border-radius: 8px; }}
#CardTitle {{ font-weight: 600; }}
#LevelBar {{ background: {t.panel}; border: 0; border-bottom: 1px solid {t.line}; }}
#LevelBar[won="true"] {{ background: {t.accent_soft}; }}
#LevelTitle {{ font-size: 15px; font-weight: 600; }}
#LevelBar[won="true"] #LevelTitle {{ color: {t.accent}; }}
#LevelText {{ color: {t.muted}; }}
#LevelValue {{ font-size: 15px; font-weight: 600; }}
#LevelText[tone="warns"] {{ color: {t.warning}; }}
#LevelText[tone="won"] {{ color: {t.text}; }}
QPushButton#LevelCard {{ background: {t.raised}; border-radius: 8px; padding: 0; }}
QPushButton#LevelCard:hover {{ border-color: {t.faint}; }}
QPushButton#LevelCard:focus {{ border: 2px solid {t.accent}; }}
#EmptyTitle {{ font-size: 22px; font-weight: 600; }}
#EmptyText {{ color: {t.muted}; font-size: 14px; }}

#Timeline {{ background: {t.panel}; border: 0; border-top: 1px solid {t.line}; }}
#LeftColumn {{ background: {t.panel}; border: 0; border-right: 1px solid {t.line}; }}
#LeftHead {{ background: {t.panel}; border: 0; }}
#HistoryPanel {{ background: transparent; border: 0; }}
#ExportBar {{ background: {t.panel}; border: 0; border-top: 1px solid {t.line}; }}
#History {{ background: transparent; border: 0; }}
QToolButton#Walk {{ padding: 5px; }}
QToolButton#Walk:hover {{ background: {t.hover}; }}
QToolButton#Walk:pressed {{ background: {t.pressed}; }}
QToolButton#Walk:focus {{ background: {t.hover}; }}
QProgressBar {{ background: {t.pressed}; border: 0; border-radius: 3px; }}
QProgressBar::chunk {{ background: {t.accent}; border-radius: 3px; }}

QListWidget {{ background: {t.background}; border: 1px solid {t.line}; border-radius: 8px;
              padding: 8px; }}
QListWidget::item {{ border-radius: 6px; padding: 8px; color: {t.text}; }}
QListWidget::item:hover {{ background: {t.hover}; }}
QListWidget::item:selected {{ background: {t.accent_soft}; color: {t.text}; }}
QScrollArea {{ background: transparent; border: 0; }}
QScrollBar:vertical {{ background: transparent; width: 10px; margin: 0; }}
QScrollBar::handle:vertical {{ background: {t.pressed}; border-radius: 4px; min-height: 24px;
                              margin: 1px; }}
QScrollBar::add-line, QScrollBar::sub-line {{ height: 0; width: 0; }}
QScrollBar::add-page, QScrollBar::sub-page {{ background: transparent; }}
QLineEdit, QSpinBox, QDoubleSpinBox {{ background: {t.raised}; border: 1px solid {t.line};
                                      border-radius: 6px; padding: 6px 8px; }}
QLineEdit:focus, QSpinBox:focus, QDoubleSpinBox:focus {{ border-color: {t.accent}; }}
QLineEdit:disabled, QSpinBox:disabled, QDoubleSpinBox:disabled {{ color: {t.faint}; }}
QAbstractSpinBox {{ padding: 6px 22px 6px 8px; }}
QAbstractSpinBox::up-button {{ subcontrol-origin: border; subcontrol-position: top right;
                              width: 20px; border: 0; margin: 2px 2px 0 0; }}
QAbstractSpinBox::down-button {{ subcontrol-origin: border; subcontrol-position: bottom right;
                                width: 20px; border: 0; margin: 0 2px 2px 0; }}
QAbstractSpinBox::up-button:hover, QAbstractSpinBox::down-button:hover {{
    background: {t.hover}; border-radius: 3px; }}
QAbstractSpinBox::up-arrow {{ image: url({icons}/up-{t.name}.svg); width: 12px; height: 12px; }}
QAbstractSpinBox::down-arrow {{ image: url({icons}/down-{t.name}.svg); width: 12px; height: 12px; }}
"""
