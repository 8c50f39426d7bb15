"""The browser side as text: bundle, modules and style sheet are complete, current and confined."""

import os
import re
import shutil
from graphlib import TopologicalSorter
from pathlib import PurePosixPath

import pytest

from meshwright.graphics.icon_paths import STROKES
from meshwright.graphics.theme import THEMES
from meshwright.notebook import build_bundle, bundle

FOLDER = bundle.FOLDER
SCRIPTS = [path.relative_to(FOLDER).as_posix() for path in build_bundle.modules()]
STYLES = sorted(path.relative_to(FOLDER).as_posix() for path in FOLDER.rglob("*.css"))
IMPORT = re.compile(r"^(?:import|export) \{([^}]*)\} from \"([^\"]+)\";", re.MULTILINE)
DECLARED = re.compile(r"^(export )?(?:async )?(?:function|class|const|let|var) (\w+)", re.MULTILINE)


def read(name: str) -> str:
    return (FOLDER / name).read_text(encoding="utf-8")


def without_comments(text: str) -> str:
    """JavaScript or CSS without comments; no string in our files looks like a comment."""
    text = re.sub(r"/\*.*?\*/", "", text, flags=re.DOTALL)
    return re.sub(r"^\s*//.*$|\s//\s.*$", "", text, flags=re.MULTILINE)


def imports(name: str) -> dict[str, list[str]]:
    """Names that a module imports, by the path of the module that exports them."""
    found: dict[str, list[str]] = {}
    for names, source in IMPORT.findall(read(name)):
        assert source.startswith("."), f"{name} imports {source}, which is not a module of ours"
        path = os.path.normpath(PurePosixPath(name).parent / source).replace(os.sep, "/")
        found[path] = [one.strip() for one in names.split(",") if one.strip()]
    return found


def exports(name: str) -> set[str]:
    """Names that a module declares and exports."""
    return {declared for exported, declared in DECLARED.findall(read(name)) if exported}


def test_the_bundle_belongs_to_the_modules():
    """Needs no Node. After an edit of a module the bundle must be built again."""
    assert build_bundle.is_current(), f"The bundle is out of date: run {build_bundle.COMMAND}"


@pytest.mark.skipif(shutil.which("npx") is None, reason="npx is missing: apt-get install npm")
def test_esbuild_makes_the_committed_bundle():
    try:
        text = build_bundle.built()
    except build_bundle.BuildError as error:
        pytest.skip(f"esbuild cannot be run: {error}")
    assert text == bundle.script(), f"The bundle is out of date: run {build_bundle.COMMAND}"


def test_all_styles_are_joined():
    assert sorted(bundle.STYLES) == STYLES


def test_every_module_is_in_the_bundle():
    joined = set(re.findall(r"^  // (\S+\.js)$", bundle.script(), flags=re.MULTILINE))
    assert joined == set(SCRIPTS)


def test_the_module_for_anywidget_exports_render_only():
    lines = without_comments(bundle.module()).splitlines()
    words = [line for line in lines if re.match(r"\s*(import|export)\b", line)]
    assert words == ["export default { render: meshwright.render };"]


@pytest.mark.parametrize("name", SCRIPTS)
def test_modules_import_what_they_use_and_use_what_they_import(name: str) -> None:
    """esbuild takes a name that is not imported for a global variable."""
    text = re.sub(r"\"(?:\\.|[^\"\\\n])*\"", '""', without_comments(IMPORT.sub("", read(name))))
    here = {declared for _, declared in DECLARED.findall(text)}
    imported = {one for source, names in imports(name).items() for one in names}
    for source, names in imports(name).items():
        assert set(names) <= exports(source), source
    forwarded = {
        one.strip()
        for names in re.findall(r"^export \{([^}]*)\} from", read(name), flags=re.MULTILINE)
        for one in names.split(",")
    }
    for other in set(SCRIPTS) - {name}:
        for one in exports(other) - here:
            used = re.search(rf"(?:(?<![\w.$])|(?<=\.\.\.)){one}(?![\w$])(?!\s*:)", text)
            ternary = re.search(rf"\? {one} :", text)
            if one in imported:
                assert used or ternary or one in forwarded, f"{one} is not used"
            else:
                assert not (used or ternary), f"{one} of {other} is not imported"


def test_modules_and_folders_have_no_import_cycle():
    modules = {name: set(imports(name)) for name in SCRIPTS}
    order = list(TopologicalSorter(modules).static_order())  # raises CycleError
    assert set(order) == set(SCRIPTS)
    folders: dict[str, set[str]] = {}
    for name, sources in modules.items():
        folder = name.rpartition("/")[0]
        others = {source.rpartition("/")[0] for source in sources} - {folder, ""}
        if folder:
            folders.setdefault(folder, set()).update(others)
    assert len(list(TopologicalSorter(folders).static_order())) >= len(folders)


def test_no_export_is_unused():
    used = {
        (source, one) for name in SCRIPTS for source, ones in imports(name).items() for one in ones
    }
    known = {(name, one) for name in SCRIPTS for one in exports(name)}
    assert known - used == {("index.js", "render")}


@pytest.mark.parametrize("name", SCRIPTS)
def test_modules_access_nothing_outside_of_the_page(name: str) -> None:
    text = without_comments(read(name))
    banned = r"\b(eval|Function|fetch|XMLHttpRequest|WebSocket|EventSource|importScripts|import)\("
    assert re.search(banned, text) is None
    assert "innerHTML" not in text
    addresses = set(re.findall(r"https?://[^\"'` )]+", text))
    assert addresses <= {"http://www.w3.org/2000/svg"}


def test_every_colour_that_is_used_exists() -> None:
    given = set(re.findall(r"^\s+(--mw-[\w-]+):", bundle.style(), flags=re.MULTILINE))
    used = set(re.findall(r"var\((--mw-[\w-]+)", bundle.style() + bundle.module()))
    assert used <= given
    for name in re.findall(r"\bcolours\.([a-z_]+)\b(?!\()", without_comments(bundle.module())):
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


@pytest.mark.parametrize("name", [name for name in SCRIPTS if name != "recording_page.js"])
def test_elements_get_no_ids(name: str) -> None:
    """Ids would clash between two views on one page."""
    text = without_comments(read(name))
    assert re.search(r"\.id = |[\"']id[\"']\s*[,:]|\bid: [\"'`]|getElementById", text) is None


def test_icons_of_the_scripts_exist() -> None:
    names = re.findall(r"\bicon\(\"(\w+)\"|\bsign: \"(\w+)\"", bundle.script())
    assert names
    for name in names:
        assert (name[0] or name[1]) in STROKES
