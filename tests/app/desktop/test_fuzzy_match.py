"""Fuzzy matching of typed letters."""

import pytest

from meshwright.desktop.help.fuzzy_match import match

TITLES = ["Flip left", "Flip right", "Fit", "Light or dark", "Save as\u2026", "Smooth", "Clean all"]


@pytest.mark.parametrize(
    ("query", "meant"),
    [
        ("fl", "Flip left"),
        ("fr", "Flip right"),
        ("flip r", "Flip right"),
        ("FIT", "Fit"),
        ("dark", "Light or dark"),
        ("sa", "Save as\u2026"),
        ("ca", "Clean all"),
        ("smth", "Smooth"),
    ],
)
def test_best_match(query, meant):
    found = {title: match(query, title) for title in TITLES}
    assert max((m.score, title) for title, m in found.items() if m)[1] == meant


def test_places_are_the_matched_letters():
    assert match("fr", "Flip right").places == (0, 5)
    assert (
        match("st", "Step").score > match("st", "Show the tour").score > match("st", "Best").score
    )
    assert match("flip", "Flip left").places == (0, 1, 2, 3)


def test_letters_out_of_order_or_absent_do_not_match():
    assert match("tf", "Fit") is None
    assert match("fitt", "Fit") is None
    assert match("a", "") is None


def test_an_empty_query_matches_everything():
    assert match("  ", "Fit").places == ()
