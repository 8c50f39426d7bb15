"""Charts that matplotlib draws: labels, colours of themes, size, and independence of settings."""

from xml.etree import ElementTree

import numpy as np
import pytest
from matplotlib.figure import Figure

from meshwright.experiments.best_of import BestOf
from meshwright.experiments.chart import add_axes, chart, short_number
from meshwright.experiments.learning import Curves, Training
from meshwright.graphics.drawing import Drawing, raster, svg
from meshwright.graphics.theme import DARK, LIGHT, THEMES, Theme


@pytest.fixture
def best_of() -> BestOf:
    rng = np.random.default_rng(3)
    return BestOf({name: rng.uniform(0.6, 1.0, 8) for name in ("first", "second")})


def points(lowest: float) -> dict[str, np.ndarray]:
    mean = np.linspace(lowest, 0.98, 12)
    decisions = np.arange(12) * 1e5
    return {"decisions": decisions, "mean": mean, "std": mean * 0.1, "at_optimum": mean**2}


def texts(picture: str) -> list[str]:
    return [e.text or "" for e in ElementTree.fromstring(picture).iter() if e.tag.endswith("text")]


@pytest.mark.parametrize(
    ("value", "text"),
    [(0.0, "0"), (0.25, "0.25"), (-2.0, "\u22122"), (1500.0, "1.5k"), (-2e6, "\u22122M")],
)
def test_tick_labels_are_short(value: float, text: str) -> None:
    assert short_number(value) == text


def test_series_are_labelled_in_text_that_can_be_searched(best_of: BestOf) -> None:
    words = texts(best_of.to_svg())
    assert {"first", "second", "k", "normalised return of the best of k rollouts"} <= set(words)
    assert [word for word in words if word.isdigit()][:8] == [str(k) for k in range(1, 9)]


def test_colours_are_those_of_the_theme(best_of: BestOf) -> None:
    for theme in THEMES.values():
        text = best_of.to_svg(theme=theme.name)
        for colour in (theme.background, theme.text, theme.muted, theme.line, theme.accent):
            assert colour in text
        assert "#0000" not in text
    live = best_of._repr_html_()
    assert f"stroke: var(--mw-accent,{LIGHT.accent})" in live
    assert DARK.accent not in live.partition("<svg")[2]


def test_a_notebooks_style_sheet_is_not_changed_by_a_chart(best_of: BestOf) -> None:
    inner = best_of._repr_html_().partition("<svg")[2]
    assert "<style" not in inner
    assert 'id="figure' not in inner


def test_settings_of_matplotlib_neither_change_a_chart_nor_are_changed(best_of: BestOf) -> None:
    from matplotlib import rc_context, rcParams

    plain = best_of.to_svg()
    with rc_context({"axes.grid": True, "font.size": 30.0, "lines.linestyle": ":"}):
        before = dict(rcParams)
        assert best_of.to_svg() == plain
        assert dict(rcParams) == before


def test_pixels_fill_the_size_at_every_scale() -> None:
    inset = chart(
        lambda figure, theme: figure.set_facecolor(theme.accent), (31, 17), LIGHT, (4.0, 3.0)
    )
    drawing = Drawing((40, 24), LIGHT.background, shapes=[inset])
    image = np.asarray(raster(drawing, samples=2))
    accent = [int(LIGHT.accent[i : i + 2], 16) for i in (1, 3, 5)]
    rows, columns = np.nonzero((image == accent).all(axis=2))
    assert (rows.min(), rows.max(), columns.min(), columns.max()) == (3, 19, 4, 34)
    assert "translate(4,3)" in svg(drawing)


def test_axes_take_whole_numbers_where_they_are_wanted() -> None:
    def draw(figure: Figure, theme: Theme) -> None:
        add_axes(figure, theme, (30, 10, 80, 80), (0, 3), (0, 2), "x", whole_y=True)

    text = svg(Drawing((120, 130), "#ffffff", shapes=[chart(draw, (120, 130), LIGHT)]))
    assert [word for word in texts(text) if word != "x"] == ["0", "2", "0", "1", "2"]


def test_learning_curves_have_a_panel_for_each_quantity_and_one_legend() -> None:
    trainings = [Training(name, points(low), {}) for name, low in (("a", 0.1), ("b", 0.4))]
    words = texts(Curves(trainings, ["mean", "at_optimum"]).to_svg())
    assert [words.count(word) for word in ("a", "b", "decisions", "200k", "1M")] == [1, 1, 2, 2, 2]
    alone = Curves(trainings[:1]).to_svg()
    assert LIGHT.accent_soft in alone and "a" not in texts(alone)
