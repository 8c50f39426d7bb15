"""Films a job that is done through the window alone, by real X events: a plate with three holes is
drawn, completed to blocks, adjusted by hand, and saved.

    python docs/make_job_film.py [FILM]

writes docs/films/plate-with-three-holes.mp4 (or FILM) in real time, with a clock, and prints one
line of JSON: the seconds that the job took, and what the saved project holds. Needs an X display of
at least 1280x800 pixels and xdotool:
``xvfb-run -s "-screen 0 1280x800x24" python docs/make_job_film.py``. No settings of the user are
read or written.
"""

import io
import json
import os
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any, TypeVar

HOME = Path(tempfile.mkdtemp())
os.environ.update(XDG_CONFIG_HOME=str(HOME), XDG_STATE_HOME=str(HOME))

import numpy as np  # noqa: E402
from PIL import Image, ImageDraw, ImageGrab  # noqa: E402
from qtpy.QtCore import QPoint, QTimer  # noqa: E402
from qtpy.QtWidgets import QAbstractButton, QApplication, QWidget  # noqa: E402

from meshwright.desktop.application.main_thread import Dispatcher  # noqa: E402
from meshwright.desktop.files.new_mesh.dialog import NewMeshDialog  # noqa: E402
from meshwright.desktop.main_window.startup import application, open_window  # noqa: E402
from meshwright.document.document import Document  # noqa: E402
from meshwright.graphics.export import video  # noqa: E402
from meshwright.graphics.mesh_figure import FigureOptions  # noqa: E402
from meshwright_agent import warm_up as agent_warm_up  # noqa: E402
from meshwright_core import HalfEdgeMesh, warm_up  # noqa: E402
from meshwright_core.geometry import quality  # noqa: E402

FILM = Path(__file__).parent / "films" / "plate-with-three-holes.mp4"
SIZE, FILMED = (1280, 800), (960, 600)
BETWEEN = 0.2
"""Seconds between two frames."""
PACE = 0.35
"""Seconds of a movement of the mouse, and of a rest after it."""
PATIENCE = 240.0
HOLES = (-0.5, 0.0, 0.5)
POINTER = ((0, 0), (0, 17), (4, 13), (7, 19), (10, 18), (7, 12), (12, 12))
Found = TypeVar("Found")


class Hand:
    """Moves the mouse and presses keys through xdotool, from a thread of its own."""

    def __init__(self) -> None:
        self._on_main = Dispatcher()
        self.at = (SIZE[0] // 2, SIZE[1] // 2)

    def ask(self, question: Callable[[], Found]) -> Found:
        """The answer to ``question()``, which is called in the main thread."""
        answers: list[Any] = []
        asked = threading.Event()

        def answer() -> None:
            try:
                answers.append(question())
            except Exception as error:  # it is raised where the question was asked
                answers.append(error)
            asked.set()

        self._on_main(answer)
        asked.wait()
        if isinstance(answers[0], Exception):
            raise answers[0]
        return answers[0]

    def until(self, question: Callable[[], Found | None]) -> Found:
        """Ask until the answer is true."""
        end = time.monotonic() + PATIENCE
        while time.monotonic() < end:
            answer = self.ask(question)
            if answer:
                return answer
            time.sleep(0.1)
        raise RuntimeError("the window did not get there")

    def move(self, place: tuple[int, int]) -> None:
        """Move the mouse to a pixel of the screen."""
        start = np.array(self.at)
        for share in np.linspace(0.0, 1.0, 9)[1:]:
            x, y = np.round(start + share * (np.array(place) - start)).astype(int).tolist()
            _xdotool("mousemove", str(x), str(y))
            time.sleep(PACE / 8)
        self.at = place
        time.sleep(PACE)

    def click(self, place: tuple[int, int]) -> None:
        """Click at a pixel of the screen."""
        self.move(place)
        _xdotool("click", "1")
        time.sleep(PACE)

    def drag(self, start: tuple[int, int], end: tuple[int, int]) -> None:
        """Press at one pixel and release at another."""
        self.move(start)
        _xdotool("mousedown", "1")
        self.move(end)
        _xdotool("mouseup", "1")
        time.sleep(PACE)

    def keys(self, *names: str) -> None:
        """Press keys by their names in X."""
        _xdotool("key", "--delay", "60", *names)
        time.sleep(PACE)

    def type(self, text: str) -> None:
        """Type a text, and Return."""
        _xdotool("type", "--delay", "80", text)
        self.keys("Return")

    def press(self, text: str) -> None:
        """Click the button with this text, once it can be pressed."""
        self.click(self.until(lambda: _centre(_button(text))))


class Camera(threading.Thread):
    """Takes pictures of the screen with the pointer and the time in them."""

    def __init__(self) -> None:
        super().__init__(daemon=True)
        self.frames: list[tuple[bytes, float]] = []
        self._ended = threading.Event()

    def run(self) -> None:
        """Take them until :meth:`end`."""
        began = time.monotonic()
        while not self._ended.is_set():
            taken = time.monotonic() - began
            self.frames.append((_packed(_picture(taken)), taken))
            self._ended.wait(BETWEEN)

    def end(self) -> None:
        """Take no more."""
        self._ended.set()
        self.join()

    def write(self, path: Path) -> None:
        """Write the film, whose last frame stays for two seconds."""
        times = [taken for _, taken in self.frames]
        lasting = [*np.diff(times).tolist(), 2.0]
        images = (Image.open(io.BytesIO(packed)).convert("RGB") for packed, _ in self.frames)
        video.save(
            path,
            zip(images, lasting, strict=True),
            len(times),
            FigureOptions(size=FILMED),
        )


def job(hand: Hand, window: Any, path: Path) -> None:
    """Draw the plate, complete it, move a vertex, look at the blocks, and save."""
    hand.press("New mesh\u2026")
    dialog = hand.until(lambda: _shown(NewMeshDialog))
    hand.press("Draw")
    area = dialog.draw.area

    def at(x: float, y: float) -> tuple[int, int]:
        return hand.ask(lambda: _global(area, area.view.to_screen(np.array((x, y)))))

    hand.press("Rectangle")
    hand.click(at(-0.8, -0.4))
    hand.move(at(0.5, 0.3))
    hand.type("1.6 0.8")
    hand.press("Circle")
    for x in HOLES:
        hand.click(at(x, 0.0))
        hand.type("0.15")
    hand.press("Make mesh")
    hand.until(lambda: window.document.mesh is not None and not _shown(NewMeshDialog))
    hand.press("Complete")
    hand.until(lambda: window.assistant.running)
    hand.until(lambda: not window.assistant.running)
    time.sleep(2.0)
    canvas, mesh = window.canvas, window.document.mesh
    place = hand.ask(lambda: _movable(mesh))

    def pixel(place: Any) -> tuple[int, int]:
        return hand.ask(lambda: _global(canvas.plotter, canvas.viewport.to_screen(place)))

    hand.drag(pixel(place), pixel(place + (0.0, 0.04, 0.0)))
    time.sleep(2.0)
    hand.press("Blocks")
    time.sleep(2.0)
    hand.keys("ctrl+s")
    hand.until(lambda: QApplication.activeModalWidget() is not None)
    time.sleep(1.0)
    hand.keys("ctrl+a")
    hand.type(str(path))
    hand.until(lambda: path.exists() and QApplication.activeModalWidget() is None)
    time.sleep(2.0)


def main(film: Path) -> None:
    """Do the job, and write the film of it."""
    app = application()
    warm_up.warm()
    agent_warm_up.warm()
    window = open_window()
    window.resize(*SIZE)
    window.move(0, 0)
    hand, camera = Hand(), Camera()
    path = HOME / "plate.meshwright"
    took: list[float] = []
    errors: list[Exception] = []

    def act() -> None:
        hand.move(hand.at)
        camera.start()
        began = time.monotonic()
        try:
            job(hand, window, path)
            took.append(time.monotonic() - began)
        except Exception as error:  # the film of a failed job shows why it failed
            errors.append(error)
        camera.end()
        hand.ask(window.leave)

    worker = threading.Thread(target=act, daemon=True)
    QTimer.singleShot(1500, worker.start)
    app.exec()
    worker.join()
    film.parent.mkdir(parents=True, exist_ok=True)
    camera.write(film)
    if errors:
        raise errors[0]
    sys.stdout.write(json.dumps({"seconds": round(took[0], 1), **_report(path)}) + "\n")


def _report(path: Path) -> dict[str, Any]:
    """What the saved project holds."""
    document = Document()
    document.open(path)
    mesh = document.mesh
    assert mesh is not None
    return {
        "blocks": mesh.n_elements,
        "s": mesh.score,
        "s*": mesh.optimum,
        "worst_scaled_jacobian": round(float(quality.scaled_jacobian(mesh).min()), 3),
        "inverted": len(quality.inverted(mesh)),
        "round_the_holes": sorted(len(loop) for loop in mesh.boundary_loops()),
        "steps": len(document.history),
        "pinned": int(mesh.pinned().sum()),
    }


def _movable(mesh: HalfEdgeMesh) -> np.ndarray:
    """Where the inner vertex is that is highest."""
    inner = np.flatnonzero(~mesh.boundary() & (mesh.degree() > 0))
    return mesh.points[inner[np.argmax(mesh.points[inner, 1])]]


def _xdotool(*words: str) -> None:
    subprocess.run(["xdotool", *words], check=True, timeout=30)


def _global(widget: QWidget, place: Any) -> tuple[int, int]:
    x, y = np.asarray(place, float)[:2].tolist()
    point = widget.mapToGlobal(QPoint(round(x), round(y)))
    return point.x(), point.y()


def _centre(widget: QWidget | None) -> tuple[int, int] | None:
    return _global(widget, (widget.width() / 2, widget.height() / 2)) if widget else None


def _button(text: str) -> QAbstractButton | None:
    """The button with this text that can be pressed, in the dialog that is open or the window."""
    over = QApplication.activeModalWidget() or QApplication.activeWindow()
    buttons = over.findChildren(QAbstractButton) if over is not None else []
    for button in buttons:
        named = text in (button.text().replace("&", ""), button.accessibleName())
        if named and button.isVisible() and button.isEnabled():
            return button
    return None


def _shown(kind: type[QWidget]) -> Any:
    over = QApplication.activeModalWidget()
    return over if isinstance(over, kind) else None


def _picture(seconds: float) -> Image.Image:
    """The screen with the pointer and the time."""
    image = ImageGrab.grab((0, 0, *SIZE), xdisplay=os.environ.get("DISPLAY"))
    words = subprocess.run(
        ["xdotool", "getmouselocation", "--shell"], capture_output=True, text=True, check=True
    ).stdout.split()
    x, y = (int(word.partition("=")[2]) for word in words[:2])
    draw = ImageDraw.Draw(image)
    draw.polygon([(x + i, y + j) for i, j in POINTER], fill="#ffffff", outline="#000000")
    small = image.resize(FILMED, Image.Resampling.LANCZOS)
    clock = f"{int(seconds) // 60}:{int(seconds) % 60:02d}"
    ImageDraw.Draw(small).text((FILMED[0] - 60, 30), clock, "#1e2329", font_size=20)
    return small


def _packed(image: Image.Image) -> bytes:
    held = io.BytesIO()
    image.save(held, "PNG", compress_level=1)
    return held.getvalue()


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else FILM)
