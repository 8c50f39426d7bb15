"""Fixtures: one browser and one server per test module that needs them."""

from collections.abc import Iterator

import pytest
from browser import Lab, WatchedPage

from meshwright.benchmarks.notebook import chromium, servers
from meshwright.console import UserError


@pytest.fixture(scope="module")
def browser() -> Iterator:
    """A Chromium. Module-scoped: while Playwright runs, its event loop is that of all tests."""
    try:
        with chromium.browser() as started:
            yield started
    except UserError as error:
        pytest.fail(f"The notebook's tests need a browser. {error}", pytrace=False)


@pytest.fixture(scope="module")
def _lab(browser, warm) -> Iterator[Lab]:
    with servers.jupyterlab() as server:
        page = browser.new_page(viewport={"width": 1280, "height": 1000})
        yield Lab(WatchedPage(page), server)


@pytest.fixture
def lab(_lab: Lab) -> Iterator[Lab]:
    """A notebook open in JupyterLab; the test must cause no console error."""
    _lab.watched.complaints.clear()
    yield _lab
    assert not _lab.watched.complaints


@pytest.fixture(scope="session")
def warm(prepared_agent) -> None:
    """Fills the kernel cache on disk, so that no server process has to compile."""
    from meshwright_core import warm_up

    warm_up.warm()
