"""One browser and one server for each module of tests that need them; both end with the module."""

from collections.abc import Iterator

import pytest
from browser import Lab, Watched

from meshwright.benchmarks.notebook import chromium, servers
from meshwright.console import UserError


@pytest.fixture(scope="module")
def browser() -> Iterator:
    """A real Chromium. Module-scoped: while Playwright runs, its event loop is everybody's."""
    try:
        with chromium.browser() as started:
            yield started
    except UserError as error:
        pytest.fail(f"The notebook's tests need a browser. {error}", pytrace=False)


@pytest.fixture(scope="module")
def _lab(browser, warm) -> Iterator[Lab]:
    with servers.jupyterlab() as server:
        page = browser.new_page(viewport={"width": 1280, "height": 1000})
        yield Lab(Watched(page), server)


@pytest.fixture
def lab(_lab: Lab) -> Iterator[Lab]:
    """A notebook open in JupyterLab; the test must leave no complaint in the browser's console."""
    _lab.watched.complaints.clear()
    yield _lab
    assert not _lab.watched.complaints


@pytest.fixture(scope="session")
def warm(prepared_agent) -> None:
    """Kernels lie compiled on the disk, so that no server's process has to begin with that."""
    from meshwright_core.core import compilation

    compilation.warm()
