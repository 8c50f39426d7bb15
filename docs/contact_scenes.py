"""The states of the window on the contact sheet: a caption and a function for each."""

from collections.abc import Callable
from functools import partial
from pathlib import Path

import numpy as np
from PIL import Image
from qtpy.QtCore import QPoint, Qt
from qtpy.QtTest import QTest
from qtpy.QtWidgets import QApplication
from stage import HOME, LARGE, SHIFT, SMALL, Stage, allowed, shape

from meshwright.assistant.policy_catalogue import shipped
from meshwright.document.operation_preview import best, choices
from meshwright_core import HalfEdgeMesh

Play = Callable[[], Image.Image]


def empty() -> Image.Image:
    """No mesh yet."""
    stage = Stage(None, "", SMALL, "light")
    return shot(stage)


def tour() -> Image.Image:
    """The second step of the tour."""
    stage = Stage(shape("star"), "star", SMALL, "light")
    stage.window.help.show_tour()
    stage.rest(0.3)
    stage.point_at(allowed(stage.window.document.mesh, "flip_left")[0])
    callout = stage.window.help.tour.callout
    QTest.mouseClick(callout.next, Qt.MouseButton.LeftButton)
    stage.rest(0.3)
    return shot(stage)


def hover(theme: str, kind: str, size: tuple[int, int], name: str) -> Image.Image:
    """After the first of two operations that lower s: preview of the second, with all changes."""
    stage = Stage(shape(name, kind), name, size, theme)
    document = stage.window.document
    first = next(
        (choice.operation, h)
        for h in allowed(document.mesh, "split")
        for choice in choices(document.mesh, h)
        if choice.change == 0 and choice.info.is_local
        if gains_after(document.mesh, choice.operation, h)
    )
    document.submit(*first)
    stage.rest(0.3)
    stage.point_at(gains(document.mesh)[0])
    return shot(stage)


def gains(mesh: HalfEdgeMesh) -> list[int]:
    """Half-edges where a local operation lowers s, those near the middle first."""
    found = [(best(choices(mesh, h)), h) for h in allowed(mesh, "collapse")]
    return [h for choice, h in found if choice.change < 0]


def gains_after(mesh: HalfEdgeMesh, operation: str, halfedge: int) -> bool:
    """Whether an operation makes another one possible that lowers s."""
    mesh = mesh.copy()
    mesh.apply(operation, halfedge)
    return bool(gains(mesh))


def menu() -> Image.Image:
    """The menu of a half-edge, with the preview of the entry below the pointer."""
    stage = Stage(shape("double-notch"), "double-notch", SMALL, "dark")
    halfedge = allowed(stage.window.document.mesh, "split")[0]
    stage.point_at(halfedge)
    QTest.mouseClick(
        stage.plotter, Qt.MouseButton.LeftButton, Qt.KeyboardModifier.NoModifier,
        stage.beside(halfedge),
    )  # fmt: skip
    stage.rest(0.4)
    popup = QApplication.activePopupWidget()
    QTest.keyClick(popup, Qt.Key.Key_Down)
    QTest.keyClick(popup, Qt.Key.Key_Down)
    stage.rest(0.3)
    image = stage.picture()
    popup.close()
    stage.close()
    return image


def selection() -> Image.Image:
    """A region chosen with the lasso, and its menu."""
    stage = Stage(scrambled(shape("plate-with-holes"), 14), "plate-with-holes", SMALL, "light")
    points = stage.window.document.mesh.points
    low, high = points[:, :2].min(axis=0), points[:, :2].max(axis=0)
    middle, radius = low + (high - low) * (0.3, 0.5), 0.34 * float((high - low).min())
    angles = np.linspace(0.0, 2.0 * np.pi, 24)
    ring = [middle + radius * np.array((1.35 * np.cos(a), np.sin(a))) for a in angles]
    stage.drag([stage.pixel(place) for place in ring], SHIFT | Qt.KeyboardModifier.AltModifier)
    QTest.mouseClick(
        stage.plotter, Qt.MouseButton.RightButton, Qt.KeyboardModifier.NoModifier,
        nearest(stage, middle),
    )  # fmt: skip
    stage.rest(0.4)
    image = stage.picture()
    popup = QApplication.activePopupWidget()
    if popup is not None:
        popup.close()
    stage.close()
    return image


def nearest(stage: Stage, place: np.ndarray) -> QPoint:
    """The pixel of the vertex nearest to a place."""
    mesh = stage.window.document.mesh
    live = mesh.vertices()
    away = np.linalg.norm(mesh.points[live][:, :2] - place, axis=1)
    return stage.pixel(mesh.points[live[int(away.argmin())]])


def dragging() -> Image.Image:
    """A vertex that is dragged, with the elements that would be inverted."""
    stage = Stage(shape("cross", "tri"), "cross", SMALL, "dark")
    mesh = stage.window.document.mesh
    inside = [v for v in mesh.vertices().tolist() if not mesh.boundary()[v]]
    start = stage.pixel(mesh.points[inside[0]])
    path = [start + QPoint(12 * i, -7 * i) for i in range(9)]
    stage.drag(path, release=False)
    image = stage.picture()
    QTest.mouseRelease(
        stage.plotter, Qt.MouseButton.LeftButton, Qt.KeyboardModifier.NoModifier, path[-1]
    )
    stage.close()
    return image


def lines() -> Image.Image:
    """Lines that can be cleaned up, one of them below the pointer."""
    mesh = cut(fewest("cross"), 2)
    stage = Stage(mesh, "cross", SMALL, "light")
    stage.window.actions_by_id["lines"].trigger()
    stage.rest(0.5)
    stage.point_at(allowed(mesh, "cleanup")[0])
    stage.rest(0.6)
    image = stage.picture()
    stage.window.actions_by_id["lines"].trigger()  # a setting, which the next windows would share
    stage.close()
    return image


def fewest(name: str) -> HalfEdgeMesh:
    """A shape of the gallery as few blocks, at the optimum where ten seconds suffice."""
    from meshwright.assistant.block_search import BlockSearch, decomposed
    from meshwright_agent.policy import policy_files

    policy = policy_files.load(shipped("quad")[0])
    return decomposed(shape(name), policy, BlockSearch(10.0))


def cut(mesh: HalfEdgeMesh, levels: int) -> HalfEdgeMesh:
    """Each quad divided into four, several times."""
    from meshwright_core.domains.elements import quadrangulation
    from meshwright_core.geometry import smoothing

    smoothing.relax(mesh)
    mesh.compact()
    points, quads, corners = mesh.points[mesh.vertices()], mesh.elements(), mesh.geometric()
    for _ in range(levels):
        points, quads, corners = quadrangulation.catmull_clark(points, [quads], corners)
    return HalfEdgeMesh.from_elements(points, quads, corners)


def hints() -> Image.Image:
    """Hints: the most probable operations as numbered previews."""
    stage = Stage(shape("double-notch"), "double-notch", LARGE, "light")
    use_policy(stage)
    stage.window.actions_by_id["agent.hint"].trigger()
    stage.until(lambda: bool(stage.window.assistant.hinting.hints))
    stage.rest(0.6)
    return shot(stage)


def agent() -> Image.Image:
    """A running policy: its template and its probabilities."""
    stage = Stage(shape("cross"), "cross", SMALL, "dark")
    use_policy(stage)
    assistant = stage.window.assistant
    assistant.watch = True
    assistant.speed = 2.0
    assistant.play()
    stage.until(lambda: len(stage.window.document.history) >= 3)
    stage.rest(0.2)
    return shot(stage)


def history() -> Image.Image:
    """Moving through the history of a run, with a branch beside it."""
    stage = Stage(shape("gear"), "gear", LARGE, "light")
    search(stage, 3.0)
    document = stage.window.document
    document.go_to(len(document.history) * 2 // 3)
    for halfedge in allowed(document.mesh, "flip_left")[:6]:
        if document.check("flip_left", halfedge):
            document.submit("flip_left", halfedge)
    stage.rest(0.4)
    if document.history.branches:
        document.take_branch(0)
    document.go_to(len(document.history) // 2)
    stage.rest(0.6)
    return shot(stage)


def optimum() -> Image.Image:
    """At the optimum."""
    stage = Stage(shape("star"), "star", LARGE, "dark")
    search(stage, 3.0)
    stage.rest(1.0)
    return shot(stage)


def quality() -> Image.Image:
    """Inverted elements, hatched, and the histogram of qualities."""
    mesh = scrambled(shape("bracket"), 0)
    stage = Stage(mesh, "bracket", LARGE, "light")
    document = stage.window.document
    document.auto_smooth = False
    inside = [v for v in mesh.vertices().tolist() if not mesh.boundary()[v]]
    rng = np.random.default_rng(3)
    for vertex in rng.choice(inside, 4, replace=False).tolist():
        place = mesh.points[[vertex]] + (0.09, 0.05, 0.0)
        document.move(np.array([vertex]), place)
    stage.rest(1.2)
    stage.window.reveal(stage.window.quality.quality)
    stage.rest(0.6)
    return shot(stage)


def error() -> Image.Image:
    """A file that is no mesh."""
    stage = Stage(shape("airfoil", "tri"), "airfoil", SMALL, "light")
    broken = Path(HOME) / "bracket.vtk"
    broken.write_text("this is no mesh\n")
    stage.window.files.open(broken)
    stage.rest(0.3)
    return shot(stage)


def new_mesh(page: str, theme: str) -> Image.Image:
    """The dialog for new meshes."""
    stage = Stage(shape("star"), "star", SMALL, theme)
    taken: list[Image.Image] = []

    def act() -> None:
        dialog = QApplication.activeModalWidget()
        dialog.show_page(page)
        if page == "draw":
            draw(stage, dialog.draw.area)
        stage.until(lambda: dialog.made is not None)
        stage.rest(0.5)
        taken.append(stage.picture_of(dialog))

    stage.during(stage.window.files.new, act, 1.0)
    stage.close()
    return taken[0]


def draw(stage: Stage, area: object) -> None:
    """Draw an outline by clicks, and begin a hole."""
    places = [(-0.9, -0.6), (0.9, -0.6), (0.9, 0.1), (0.3, 0.1), (0.3, 0.6), (-0.9, 0.6)]
    hole = [(-0.6, -0.3), (-0.1, -0.3), (-0.1, 0.2), (-0.6, 0.2)]
    dialog = area.window()
    for loop in (places, hole):
        if loop is hole:
            QTest.mouseClick(dialog.draw.hole, Qt.MouseButton.LeftButton)
        for place in [*loop, loop[0]]:
            x, y = area.view.to_screen(np.array(place)).tolist()
            at = QPoint(round(x), round(y))
            QTest.mouseMove(area, at)
            QTest.mouseClick(area, Qt.MouseButton.LeftButton, Qt.KeyboardModifier.NoModifier, at)
            stage.rest(0.05)


def dialog(show: Callable[[Stage], Callable[[], None]], theme: str, keys: str = "") -> Image.Image:
    """A window with the dialog that ``show`` opens."""
    stage = Stage(shape("bracket"), "bracket", SMALL, theme)
    search(stage, 1.0)
    taken: list[Image.Image] = []

    def act() -> None:
        if keys:
            QTest.keyClicks(QApplication.focusWidget(), keys)
        stage.rest(0.5)
        taken.append(stage.picture_of(QApplication.activeModalWidget()))

    stage.during(show(stage), act, 0.8)
    stage.close()
    return taken[0]


def palette() -> Image.Image:
    """The command palette."""
    stage = Stage(shape("h-shape"), "h-shape", SMALL, "dark")
    stage.window.actions_by_id["palette"].trigger()
    stage.rest(0.3)
    QTest.keyClicks(stage.window.help.palette.field, "sp")
    stage.rest(0.3)
    return shot(stage)


def scrambled(mesh: HalfEdgeMesh, seed: int, count: int = 10) -> HalfEdgeMesh:
    """The mesh after a few random flips, smoothed."""
    from meshwright_core.geometry import smoothing

    rng = np.random.default_rng(seed)
    for h in rng.integers(0, mesh.k * mesh.n_elements, count).tolist():
        name = "flip_left" if mesh.k == 4 else "flip"
        if mesh.check(name, h):
            mesh.apply(name, h)
    smoothing.relax(mesh)
    return mesh.copy()


def use_policy(stage: Stage) -> None:
    """Wait until the agent is ready."""
    stage.window.assistant.policy = shipped(stage.window.document.kind)[0]
    stage.window.readiness.agent = True


def search(stage: Stage, seconds: float) -> None:
    """Run a search of some seconds; its result is applied."""
    from meshwright.assistant.search_runner import Effort

    use_policy(stage)
    stage.window.assistant.search(Effort(seconds=seconds))
    stage.until(lambda: not stage.window.assistant.running)
    stage.rest(0.6)


def shot(stage: Stage) -> Image.Image:
    """Take a picture and close the window."""
    image = stage.picture()
    stage.close()
    return image


SCENES: dict[str, tuple[str, Play]] = {
    "empty": ("No mesh yet", empty),
    "tour": ("The tour", tour),
    "hover": (
        "Preview of an operation, and the change of s of each",
        partial(hover, "light", "quad", SMALL, "cross"),
    ),
    "triangles": (
        "Triangles, dark, 1920 x 1080",
        partial(hover, "dark", "tri", LARGE, "airfoil"),
    ),
    "menu": ("The menu previews the operation under the mouse", menu),
    "selection": ("A selected region, and its menu", selection),
    "drag": ("Dragging a vertex: inverted elements are hatched", dragging),
    "lines": ("Removable lines", lines),
    "hints": ("Hints: the most probable operations", hints),
    "agent": ("What the policy sees during a run", agent),
    "history": ("The history of a run, with a branch", history),
    "optimum": ("At the optimum", optimum),
    "quality": ("Inverted elements and quality", quality),
    "error": ("An error message", error),
    "new-mesh": (
        "New mesh: the gallery, with a live preview",
        partial(new_mesh, "gallery", "light"),
    ),
    "random": ("New mesh: a random polygon", partial(new_mesh, "random", "dark")),
    "draw": ("New mesh: drawn by hand", partial(new_mesh, "draw", "light")),
    "palette": ("The command palette", palette),
    "export": (
        "Export as a video",
        partial(dialog, lambda stage: stage.window.playback.exporting.ask, "light"),
    ),
    "preferences": (
        "Preferences",
        partial(dialog, lambda stage: stage.window.preferences.show, "dark"),
    ),
    "about": (
        "About, with all licences",
        partial(dialog, lambda stage: stage.window.help.show_about, "light"),
    ),
}
