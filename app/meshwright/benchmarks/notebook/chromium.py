"""A real Chromium without a window, driven by Playwright."""

from __future__ import annotations

import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

from meshwright.benchmarks.notebook.servers import need
from meshwright.console import UserError

if TYPE_CHECKING:
    from playwright.sync_api import Browser

NAMES = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable")
SWITCHES = (
    "--no-sandbox",  # it does not start as root with one
    "--disable-gpu",
    "--disable-dev-shm-usage",
    "--disable-quic",
    "--no-first-run",
    "--no-proxy-server",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--force-color-profile=srgb",
)


def executable() -> str:
    """Where Chromium is; UserError, which names the package, if it is nowhere."""
    for name in NAMES:
        found = shutil.which(name)
        if found:
            return found
    raise UserError("Chromium is not installed: install the package chromium")


@contextmanager
def browser() -> Iterator[Browser]:
    """Start Chromium and yield Playwright's Browser; UserError if something is not installed."""
    need("playwright", "Playwright")
    path = executable()
    from playwright.sync_api import sync_playwright

    with sync_playwright() as playwright:
        started = playwright.chromium.launch(
            executable_path=path, headless=True, args=list(SWITCHES), timeout=60_000
        )
        try:
            yield started
        finally:
            started.close()
