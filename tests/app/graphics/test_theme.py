"""The themes can be read: contrast of words, and pairs of colours that do not rest on hue alone."""

import pytest

from meshwright.graphics.theme import COLOURS, THEMES, Theme, style_sheet, theme


def luminance(colour: str) -> float:
    """Relative luminance of the Web Content Accessibility Guidelines."""
    channels = [int(colour[i : i + 2], 16) / 255 for i in (1, 3, 5)]
    linear = [c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in channels]
    return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]


def contrast(one: str, other: str) -> float:
    low, high = sorted((luminance(one), luminance(other)))
    return (high + 0.05) / (low + 0.05)


@pytest.fixture(params=[(name, colours) for name in THEMES for colours in COLOURS])
def look(request) -> Theme:
    return theme(*request.param)


def test_words_can_be_read(look):
    for ink in (look.text, look.muted, look.warning):
        for ground in (look.panel, look.raised, look.background):
            assert contrast(ink, ground) >= 4.5, (ink, ground)
    assert contrast(look.accent_text, look.accent) >= 4.5
    assert contrast(look.warning, look.warning_soft) >= 4.5
    assert contrast(look.text, look.accent_soft) >= 4.5


def test_markers_are_seen_and_their_numbers_can_be_read(look):
    for disc in (look.plus, look.minus):
        assert contrast(look.marker_text, disc) >= 3.0  # large and bold
        assert contrast(disc, look.fill) >= 2.0


def test_warm_and_cold_differ_in_what_every_eye_sees(look):
    """Blue against yellow is the axis that eyes without red or green cones have left."""

    def yellow(colour: str) -> float:
        red, green, blue = (int(colour[i : i + 2], 16) for i in (1, 3, 5))
        return (red + green) / 2 - blue

    assert yellow(look.plus) - yellow(look.minus) > 80


def test_an_unknown_theme_is_refused_in_words():
    with pytest.raises(ValueError, match="There is no theme 'mauve'; choose one of light, dark"):
        theme("mauve")


def test_every_icon_of_the_style_sheet_is_there(look):
    import re
    from pathlib import Path

    paths = re.findall(r"url\((.*?)\)", style_sheet(look))
    assert paths
    assert [path for path in paths if not Path(path).is_file()] == []
