"""Icons as SVG strokes on a grid of 20, drawn in the colours of the theme."""

from qtpy.QtCore import QByteArray, QSize, Qt
from qtpy.QtGui import QIcon, QPainter, QPixmap, QPixmapCache
from qtpy.QtSvg import QSvgRenderer

from meshwright.graphics.icon_paths import STROKES, WINDOW_STROKES
from meshwright.graphics.theme import Theme

SIZE = 20
_STROKES = {**STROKES, **WINDOW_STROKES}


def pixmap(name: str, colour: str, size: int = SIZE, ratio: float = 1.0) -> QPixmap:
    """One icon in one colour; ``size`` in logical pixels. Each is drawn once and shared."""
    key, drawn = f"meshwright {name} {colour} {size} {ratio}", QPixmap()
    if not QPixmapCache.find(key, drawn):
        drawn = _drawn(name, colour, size, ratio)
        QPixmapCache.insert(key, drawn)
    return drawn


def _drawn(name: str, colour: str, size: int, ratio: float) -> QPixmap:
    svg = (
        '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 20 20" fill="none" '
        f'stroke="{colour}" stroke-width="1.5" stroke-linecap="round" stroke-linejoin="round">'
        f'<path d="{_STROKES[name]}"/></svg>'
    )
    drawn = QPixmap(QSize(size, size) * ratio)
    drawn.fill(Qt.GlobalColor.transparent)
    painter = QPainter(drawn)
    painter.setRenderHint(QPainter.RenderHint.Antialiasing)
    QSvgRenderer(QByteArray(svg.encode())).render(painter)
    painter.end()
    drawn.setDevicePixelRatio(ratio)
    return drawn


def icon(name: str, theme: Theme) -> QIcon:
    """The icon for buttons, paler where they are disabled."""
    made = QIcon()
    for ratio in (1.0, 2.0):
        made.addPixmap(pixmap(name, theme.text, ratio=ratio), QIcon.Mode.Normal)
        made.addPixmap(pixmap(name, theme.faint, ratio=ratio), QIcon.Mode.Disabled)
    return made


def fold(theme: Theme) -> QIcon:
    """The fold icon of a heading: pointing down while unfolded, right while folded."""
    made = QIcon()
    for ratio in (1.0, 2.0):
        for name, state in (("down", QIcon.State.On), ("right", QIcon.State.Off)):
            drawn = pixmap(name, theme.muted, 16, ratio)
            made.addPixmap(drawn, QIcon.Mode.Normal, state)
    return made


def app_icon() -> QIcon:
    """The program's own icon: four quads around a vertex that is one edge short."""
    drawn = QPixmap(64, 64)
    drawn.fill(Qt.GlobalColor.transparent)
    svg = (
        '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 64 64" stroke-linejoin="round">'
        '<path d="M8 20L34 6 58 22 50 56 14 54z" fill="#f1f2ed" stroke="#2f3b48" '
        'stroke-width="4"/>'
        '<path d="M30 32L34 6M30 32L54 40M30 32L11 38M30 32L32 55" stroke="#5d6b79" '
        'stroke-width="3" fill="none"/>'
        '<circle cx="30" cy="32" r="9" fill="#d55e00"/></svg>'
    )
    painter = QPainter(drawn)
    QSvgRenderer(QByteArray(svg.encode())).render(painter)
    painter.end()
    return QIcon(drawn)
