"""Every lesson runs from top to bottom in a kernel, blank and solved, and is fit to be read.

One kernel runs all of them, each from an empty namespace in an empty folder: starting one and
importing PyTorch in it takes longer than most lessons.

nbformat and nbclient are imported inside functions: they load the grammars of JSON schemas, which
takes seconds, in every process that collects the tests.
"""

import ast
import copy
import itertools
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from meshwright.teaching import lessons
from meshwright.teaching.exercises.result import BLANK, MIME, RIGHT, WRONG
from meshwright.teaching.lessons import Lesson

pytestmark = pytest.mark.slow

WIDGET = "application/vnd.jupyter.widget-view+json"
ALLOWED_LINKS = {
    "https://arxiv.org/abs/1707.06347",
    "https://en.wikipedia.org/wiki/Doubly_connected_edge_list",
    "https://en.wikipedia.org/wiki/Euler_characteristic",
    "https://en.wikipedia.org/wiki/Gauss%E2%80%93Bonnet_theorem",
}
"""Pages outside that a lesson may send a reader to."""

LONG = re.compile(
    r"\b(mw\.compare|mw\.table_row|Trainer|trainer\.improve)\("
    r"|^(?P<made>\w+) = mw\.MeshWidget\([^\n]*\n(?P=made)\.complete\(",
    re.MULTILINE,
)
"""Calls that search, measure or train for many seconds, in cells that no answer has a part in."""

LONGEST_CELL = 10
WORDS = (500, 1800)

LESSONS = lessons.shipped()
every_lesson = pytest.mark.parametrize("lesson", LESSONS, ids=lambda lesson: lesson.name)


def book(lesson: Lesson) -> Any:
    import nbformat

    return nbformat.read(lesson.path, as_version=4)


def exercise_of(cell: Any) -> dict[str, Any] | None:
    about = cell.metadata.get("meshwright", {})
    return about if "exercise" in about else None


def tried(cell: Any, code: str, state: str) -> Any:
    """The cell with an answer, marked with what should come of it."""
    from nbformat import v4

    name = cell.metadata.meshwright.exercise
    source = lessons.ExerciseCell(name, cell.source, "", ()).answered(code)
    made = v4.new_code_cell(source)
    made.metadata["wanted"] = state
    return made


def is_long(cell: Any) -> bool:
    return cell.cell_type == "code" and LONG.search(cell.source) is not None


def assigned(cell: Any) -> set[str]:
    """The names that the cell binds, but for those in functions."""
    nodes = [node for part in ast.parse(cell.source).body for node in ast.walk(part)]
    return {n.id for n in nodes if isinstance(n, ast.Name) and isinstance(n.ctx, ast.Store)}


def blank_then_solved(notebook: Any) -> Any:
    """The cells of a lesson as shipped, then from an empty namespace with wrong answers and with
    solutions: one notebook, so that one kernel is started.

    What cells with a :data:`LONG` call have made stays in the namespace, and they run once.
    """
    from nbformat import v4

    cells = []
    kept: set[str] = set()
    for cell in notebook.cells:
        shipped = copy.deepcopy(cell)
        if exercise_of(cell) is not None:
            shipped.metadata["wanted"] = BLANK
        elif is_long(cell):
            kept |= assigned(cell)
        cells.append(shipped)
    cells.append(v4.new_code_cell(rf"%reset_selective -f ^(?!({'|'.join(kept)})$)"))
    for cell in notebook.cells:
        about = exercise_of(cell)
        if about is None:
            if not is_long(cell):
                cells.append(copy.deepcopy(cell))
            continue
        cells += [tried(cell, code, WRONG) for code in about["wrong"]]
        cells.append(tried(cell, about["solution"], RIGHT))
    made = v4.new_notebook(metadata=notebook.metadata)
    made.cells = [cell for cell in cells if cell.cell_type == "code"]
    for i, cell in enumerate(made.cells):
        cell["id"] = f"cell-{i}"
    return made


@pytest.fixture(scope="module")
def kernel() -> Iterator[Any]:
    """The manager of a running kernel."""
    from jupyter_client.manager import KernelManager

    manager = KernelManager(kernel_name="python3")
    manager.start_kernel()
    try:
        yield manager
    finally:
        manager.shutdown_kernel(now=True)


@every_lesson
def test_runs_blank_and_solved(lesson: Lesson, kernel: Any, tmp_path: Path):
    from nbclient import NotebookClient
    from nbformat import v4

    notebook = blank_then_solved(book(lesson))
    notebook.cells.insert(0, v4.new_code_cell(f"%reset -f\n%cd -q {tmp_path}"))
    NotebookClient(notebook, km=kernel, timeout=120).execute()  # an error in a cell is raised here
    assert notebook.cells.pop(0).outputs == []
    for cell in notebook.cells:
        wanted = cell.metadata.get("wanted")
        answers = [out.data[MIME] for out in cell.outputs if MIME in out.get("data", {})]
        if wanted is not None:
            assert [answer["state"] for answer in answers] == [wanted], cell.source
    first = notebook.cells[0]
    assert any(WIDGET in out.get("data", {}) for out in first.outputs)


@every_lesson
def test_is_valid_and_carries_no_outputs(lesson: Lesson):
    import nbformat

    notebook = book(lesson)
    nbformat.validate(notebook)
    for number, cell in enumerate(notebook.cells, 1):
        assert cell.id == f"{lesson.name[3:]}-{number:02d}"
        if cell.cell_type == "code":
            assert cell.outputs == []
            assert cell.execution_count is None


@every_lesson
def test_begins_with_a_picture_and_a_widget(lesson: Lesson):
    first, second = book(lesson).cells[:2]
    assert first.cell_type == "markdown"
    assert first.source.startswith("# ")
    assert "attachment:" in first.source
    assert second.cell_type == "code"
    assert "MeshWidget(" in second.source
    assert len([line for line in second.source.split("\n") if line.strip()]) <= 3


@every_lesson
def test_cells_are_short(lesson: Lesson):
    for cell in book(lesson).cells:
        if cell.cell_type == "code":
            assert len(cell.source.split("\n")) <= LONGEST_CELL, cell.source


@every_lesson
def test_pictures_are_there_and_have_words(lesson: Lesson):
    for cell in book(lesson).cells:
        if cell.cell_type == "markdown":
            wanted = set(re.findall(r"attachment:([\w.-]+)", cell.source))
            assert wanted == set(cell.get("attachments", {}))
            # nbconvert embeds attachments of this syntax only
            assert "<img" not in cell.source
            for words in re.findall(r"!\[([^\]]*)\]\(attachment:", cell.source):
                assert len(words) >= 20


@every_lesson
def test_pictures_survive_nbconvert(lesson: Lesson):
    exporter = pytest.importorskip("nbconvert").HTMLExporter(template_name="basic")
    page, _ = exporter.from_notebook_node(book(lesson))
    pictures = sum(len(cell.get("attachments", {})) for cell in book(lesson).cells)
    assert "attachment:" not in page
    assert page.count('src="data:image/png;base64,') == pictures > 0


@every_lesson
def test_links_lead_somewhere(lesson: Lesson):
    text = "\n".join(cell.source for cell in book(lesson).cells if cell.cell_type == "markdown")
    for target in re.findall(r"\]\(([^)]+)\)", text):
        if target.startswith("http"):
            assert target in ALLOWED_LINKS
        elif not target.startswith("attachment:"):
            assert (lesson.path.parent / target.split("#")[0]).is_file(), target


@every_lesson
def test_names_the_next_lesson(lesson: Lesson):
    place = LESSONS.index(lesson)
    last = book(lesson).cells[-1]
    assert "## What you know now" in last.source
    if place + 1 < len(LESSONS):
        following = LESSONS[place + 1]
        assert (
            f"[Lesson {following.number}: {following.title}]({following.path.name})" in last.source
        )


@every_lesson
def test_takes_as_long_as_it_says(lesson: Lesson):
    cells = book(lesson).cells
    words = sum(len(cell.source.split()) for cell in cells if cell.cell_type == "markdown")
    exercises = len(list(lesson.exercises()))
    others = sum(cell.cell_type == "code" for cell in cells) - exercises
    assert WORDS[0] <= words <= WORDS[1]
    assert exercises >= 3
    assert 20 <= lesson.minutes <= 30
    assert abs(words / 160 + 2.5 * exercises + 0.5 * others - lesson.minutes) <= 3


@every_lesson
def test_exercises_are_numbered_and_asked(lesson: Lesson):
    cells = book(lesson).cells
    numbers = [about["exercise"] for cell in cells if (about := exercise_of(cell))]
    assert numbers == [f"{lesson.number}.{i}" for i in range(1, len(numbers) + 1)]
    for before, cell in itertools.pairwise(cells):
        if about := exercise_of(cell):
            assert f"### Exercise {about['exercise']}\n" in before.source
            assert f'mw.exercise("{about["exercise"]}").check(' in cell.source.split("\n")[-1]
            assert about["solution"].strip()
            assert about["wrong"]


def test_there_are_enough_lessons_in_order():
    assert [lesson.number for lesson in LESSONS] == list(range(1, len(LESSONS) + 1))
    assert all(lesson.name.startswith(f"{lesson.number:02d}-") for lesson in LESSONS)
