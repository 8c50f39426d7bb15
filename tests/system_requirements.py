"""What some tests need besides Python packages, whether it is here, and how it is installed.

Run as a program it lists the Debian packages that all tests together need; ``.ci/run`` installs
these. It imports only the standard library, so that it runs before anything is installed.
"""

from __future__ import annotations

import functools
import os
import shutil
import subprocess
import sys
from collections.abc import Callable

QT_PACKAGES = (
    "libegl1", "libgl1", "libglib2.0-0", "libfontconfig1", "libdbus-1-3", "libxkbcommon0",
    "libx11-6", "fonts-dejavu-core",
)  # fmt: skip
XCB_PACKAGES = (
    "libx11-xcb1", "libxkbcommon-x11-0", "libxcb-cursor0", "libxcb-icccm4", "libxcb-image0",
    "libxcb-keysyms1", "libxcb-randr0", "libxcb-render-util0", "libxcb-shape0", "libxcb-shm0",
    "libxcb-sync1", "libxcb-xfixes0", "libxcb-xkb1",
)  # fmt: skip
XVFB_PACKAGES = ("xvfb",)
OPENGL_PACKAGES = ("libgl1-mesa-dri",)
XDOTOOL_PACKAGES = ("xdotool",)
CHROMIUM_PACKAGES = ("chromium", "fonts-liberation", "libatomic1")  # the last for Playwright

PROBE = """
from qtpy.QtGui import QGuiApplication, QOffscreenSurface, QOpenGLContext, QSurfaceFormat
application = QGuiApplication([])
print("display", flush=True)
wanted = QSurfaceFormat()
wanted.setProfile(QSurfaceFormat.OpenGLContextProfile.CoreProfile)
wanted.setVersion(3, 2)
context = QOpenGLContext()
context.setFormat(wanted)
surface = QOffscreenSurface()
surface.setFormat(wanted)
surface.create()
if context.create() and context.makeCurrent(surface):
    version = context.format().version()
    if (version[0], version[1]) >= (3, 2):
        print("opengl", flush=True)
"""
PROBE_SECONDS = 60.0


def install_line(*packages: str) -> str:
    """The command that installs Debian packages; on other systems nothing but a hint."""
    if sys.platform.startswith("linux"):
        return f"apt-get install {' '.join(packages)}"
    return "see CONTRIBUTING.md"


@functools.cache
def missing_qt() -> str:
    """Why Qt cannot be imported, in words; empty if it can."""
    try:
        # not by qtpy, which hides why an import fails
        from PySide6 import QtGui, QtTest, QtWidgets  # noqa: F401
    except ImportError as error:
        return f"needs the libraries that Qt loads ({error}): {install_line(*QT_PACKAGES)}"
    return ""


@functools.cache
def _probe() -> tuple[set[str], str]:
    """What of a display and OpenGL 3.2 a child process finds, and the first line of its complaint.

    A child, since Qt ends the whole process where it cannot open its display.
    """
    try:
        done = subprocess.run(
            [sys.executable, "-c", PROBE], capture_output=True, text=True, timeout=PROBE_SECONDS
        )
    except subprocess.TimeoutExpired:
        return set(), f"no answer within {PROBE_SECONDS:.0f} seconds"
    complaints = [line.strip() for line in done.stderr.splitlines() if line.strip()]
    return set(done.stdout.split()), complaints[0] if complaints else ""


@functools.cache
def missing_display() -> str:
    """Why no window can be shown, in words; empty if one can. A virtual display counts."""
    if missing_qt():
        return missing_qt()
    on_x11 = sys.platform not in ("win32", "darwin")
    if on_x11 and not os.environ.get("DISPLAY") and not os.environ.get("WAYLAND_DISPLAY"):
        return f"needs a display or Xvfb: {install_line(*XVFB_PACKAGES, *XCB_PACKAGES)}"
    found, complaint = _probe()
    if "display" not in found:
        return f"needs a display that Qt can open ({complaint}): {install_line(*XCB_PACKAGES)}"
    return ""


@functools.cache
def missing_window() -> str:
    """Why the program's window, which draws with OpenGL, cannot be shown; empty if it can."""
    if missing_display():
        return missing_display()
    if "opengl" not in _probe()[0]:
        return f"needs OpenGL 3.2: {install_line(*OPENGL_PACKAGES)}"
    return ""


def missing_xdotool() -> str:
    """Why no events can be sent through the X server; empty if they can."""
    if shutil.which("xdotool") is None:
        return f"needs xdotool: {install_line(*XDOTOOL_PACKAGES)}"
    return "" if os.environ.get("DISPLAY") else "needs an X server for xdotool"


@functools.cache
def missing_chromium() -> str:
    """Why no browser can be started; empty if one can."""
    from meshwright.benchmarks.notebook import chromium
    from meshwright.console import UserError

    try:
        chromium.executable()
    except UserError:
        return f"needs Chromium: {install_line(*CHROMIUM_PACKAGES)}"
    done = subprocess.run(
        [sys.executable, "-m", "playwright", "--version"], capture_output=True, text=True
    )
    if done.returncode != 0:
        cause = (done.stderr.strip().splitlines() or ["no message"])[-1]
        return f"needs the libraries of Playwright ({cause}): {install_line(*CHROMIUM_PACKAGES)}"
    return ""


MISSING: dict[str, Callable[[], str]] = {
    "qt": missing_qt,
    "display": missing_display,
    "window": missing_window,
    "xdotool": missing_xdotool,
    "chromium": missing_chromium,
}
"""For each name of the marker ``needs``: why it is not there, or an empty text."""


if __name__ == "__main__":
    packages = (
        *XVFB_PACKAGES, *QT_PACKAGES, *XCB_PACKAGES, *OPENGL_PACKAGES, *XDOTOOL_PACKAGES,
        *CHROMIUM_PACKAGES,
    )  # fmt: skip
    sys.stdout.write("\n".join(packages) + "\n")
