"""Themes: contrast of text and markers, and colours for colour-blind people."""

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
def colours(request) -> Theme:
    return theme(*request.param)


def test_text_has_enough_contrast(colours):
    for ink in (colours.text, colours.muted, colours.warning):
        for ground in (colours.panel, colours.raised, colours.background):
            assert contrast(ink, ground) >= 4.5, (ink, ground)
    assert contrast(colours.text, colours.panel) >= 7.0
    assert contrast(colours.accent_text, colours.accent) >= 4.5
    assert contrast(colours.warning, colours.warning_soft) >= 4.5
    assert contrast(colours.text, colours.accent_soft) >= 4.5


def test_markers_and_their_numbers_have_enough_contrast(colours):
    for disc in (colours.plus, colours.minus):
        assert contrast(colours.marker_text, disc) >= 3.0  # large and bold
        assert contrast(disc, colours.fill) >= 2.0


def test_colour_blind_people_can_tell_plus_and_minus_apart(colours):
    """Blue against yellow is the axis that eyes without red or green cones have left."""

    def yellow(colour: str) -> float:
        red, green, blue = (int(colour[i : i + 2], 16) for i in (1, 3, 5))
        return (red + green) / 2 - blue

    assert yellow(colours.plus) - yellow(colours.minus) > 80


def test_unknown_theme_is_refused():
    with pytest.raises(ValueError, match="There is no theme 'mauve'; choose one of light, dark"):
        theme("mauve")


def test_style_sheet_has_no_open_placeholders(colours):
    assert "{t." not in style_sheet(colours)


def test_icons_of_the_style_sheet_exist(colours):
    import re
    from pathlib import Path

    paths = re.findall(r"url\((.*?)\)", style_sheet(colours))
    assert paths
    assert [path for path in paths if not Path(path).is_file()] == []
