"""The browser side as text: the joined module and its style are whole, and keep to themselves."""

import json
import re
from pathlib import Path

import pytest

from meshwright.graphics.theme import THEMES
from meshwright.notebook import bundle

FOLDER = Path(bundle.__file__).parent / "front"
SCRIPTS = sorted(path.relative_to(FOLDER).as_posix() for path in FOLDER.rglob("*.js"))
STYLES = sorted(path.relative_to(FOLDER).as_posix() for path in FOLDER.rglob("*.css"))


def read(name: str) -> str:
    return (FOLDER / name).read_text(encoding="utf-8")


def without_comments(text: str) -> str:
    """JavaScript or CSS without its comments; strings are none in ours that look like comments."""
    text = re.sub(r"/\*.*?\*/", "", text, flags=re.DOTALL)
    return re.sub(r"^\s*//.*$|\s//\s.*$", "", text, flags=re.MULTILINE)


def declared(text: str) -> list[str]:
    """Names at the top level of a script."""
    pattern = r"^(?:async )?(?:function|class|const|let|var) (\w+)"
    return re.findall(pattern, text, flags=re.MULTILINE)


def test_every_file_is_listed_once_and_there() -> None:
    assert sorted(bundle.SCRIPTS) == SCRIPTS
    assert sorted(bundle.STYLES) == STYLES


def test_names_are_declared_once_in_the_whole_module() -> None:
    names = declared(bundle.module())
    assert len(names) > 100
    assert sorted(names) == sorted(set(names))


def test_the_module_exports_its_door_and_imports_nothing() -> None:
    lines = without_comments(bundle.module()).splitlines()
    words = [line for line in lines if re.match(r"\s*(import|export)\b", line)]
    assert words == ["export default { render };"]
    assert bundle.module().endswith(bundle.EXPORT)
    assert bundle.script() + bundle.EXPORT == bundle.module()


@pytest.mark.parametrize("name", SCRIPTS)
def test_scripts_reach_for_nothing_outside_the_page(name: str) -> None:
    text = without_comments(read(name))
    banned = r"\b(eval|Function|fetch|XMLHttpRequest|WebSocket|EventSource|importScripts|import)\("
    assert re.search(banned, text) is None
    assert "innerHTML" not in text
    addresses = set(re.findall(r"https?://[^\"'` )]+", text))
    assert addresses <= {"http://www.w3.org/2000/svg"}


@pytest.mark.parametrize("name", SCRIPTS)
def test_brackets_are_closed(name: str) -> None:
    text = without_comments(read(name))
    text = re.sub(r"`(?:\\.|[^`\\])*`|\"(?:\\.|[^\"\\\n])*\"|'(?:\\.|[^'\\\n])*'", "", text)
    text = re.sub(r"(?<=[(,=:?] )/(?:\\.|[^/\n\\])+/|(?<=[(!])/(?:\\.|[^/\n\\])+/", "", text)
    for opening, closing in ("()", "[]", "{}"):
        assert text.count(opening) == text.count(closing), opening


@pytest.mark.parametrize("name", SCRIPTS + STYLES)
def test_files_are_short(name: str) -> None:
    assert len(read(name).splitlines()) <= 450


def test_every_colour_that_is_used_exists() -> None:
    given = set(re.findall(r"^\s+(--mw-[\w-]+):", bundle.style(), flags=re.MULTILINE))
    used = set(re.findall(r"var\((--mw-[\w-]+)", bundle.style() + bundle.module()))
    assert used <= given
    for name in re.findall(r"\bpalette\.([a-z_]+)\b(?!\()", without_comments(bundle.module())):
        if name not in ("font", "theme"):
            assert bundle.variable(name) in given


def test_both_themes_give_the_same_variables() -> None:
    rules = [bundle.variables(theme) for theme in THEMES.values()]
    names = [re.findall(r"--mw-[\w-]+(?=:)", rule) for rule in rules]
    assert names[0] == names[1]
    for theme, rule in zip(THEMES.values(), rules, strict=True):
        assert f'data-theme="{theme.name}"' in rule
        assert theme.accent in rule


@pytest.mark.parametrize("name", STYLES)
def test_styles_apply_to_the_card_only(name: str) -> None:
    text = without_comments(read(name))
    text = re.sub(r"@keyframes mw-[\w-]+ \{(?:[^{}]*\{[^{}]*\})*\s*\}", "", text)
    text = re.sub(r"@(media|container)[^{]*\{", "", text)
    selectors = [part for rule in re.findall(r"([^{}]+)\{", text) for part in rule.split(",")]
    assert selectors
    for selector in selectors:
        assert selector.strip().startswith(f".{bundle.ROOT}"), selector


@pytest.mark.parametrize("name", STYLES)
def test_colours_are_those_of_the_theme(name: str) -> None:
    assert re.search(r"#[0-9a-fA-F]{3,8}\b", without_comments(read(name))) is None


@pytest.mark.parametrize("name", SCRIPTS)
def test_elements_get_no_ids(name: str) -> None:
    """Two views on one page must not get into each other's way."""
    text = without_comments(read(name))
    assert re.search(r"\.id = |[\"']id[\"']\s*[,:]|\bid: [\"'`]|getElementById", text) is None


def test_icons_of_the_scripts_exist() -> None:
    strokes = json.loads(
        bundle.constants().split("ICON_STROKES = ", 1)[1].rstrip(";\n").replace("\n", " ")
    )
    for name in re.findall(r"\bicon\(\"(\w+)\"|\bsign: \"(\w+)\"", bundle.module()):
        assert (name[0] or name[1]) in strokes
