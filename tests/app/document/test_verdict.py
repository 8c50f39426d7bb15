"""What is said of a mesh as an answer."""

from meshwright.document.verdict import findings


def test_long_thin_elements_are_said_where_there_are_any(star):
    sound = findings(star, worst=0.7, flattest=0.4, bound=0.8, inverted=0)
    assert [one.in_order for one in sound[:2]] == [True, True]
    thin = findings(star, worst=0.7, flattest=0.01, bound=0.8, inverted=0)
    assert thin[:-1] == sound
    assert thin[-1].text == "Long thin elements: shape .01" and not thin[-1].in_order


def test_inverted_elements_are_said_once(star):
    said = findings(star, worst=-0.2, flattest=-0.2, bound=0.8, inverted=2)
    assert [one.text for one in said if not one.in_order][:2] == [
        "Shape \u2212.20 of at most .80", "2 inverted",
    ]  # fmt: skip
    assert not any("thin" in one.text for one in said)
