"""Skips tests whose display, browser or other program is missing, and compiles kernels first."""

import os
import shutil
import signal
from pathlib import Path

import pytest
import system_requirements
from hypothesis import HealthCheck, settings

# One thread each for the small products of the policies, before anything imports PyTorch: more of
# them only wait for each other, and take the cores from the tests that run beside.
os.environ.setdefault("OMP_NUM_THREADS", "1")

HERE = Path(__file__).parent
MOST_WORKERS = 8
"""Each holds PyTorch, Qt and the kernels, which is about a gigabyte."""
NEEDED_BY_FIXTURE = {"qapp": "qt", "open_window": "window", "browser": "chromium"}

# no property fails because the machine is slow
settings.register_profile("suite", deadline=None, suppress_health_check=[HealthCheck.too_slow])
settings.load_profile("suite")


def pytest_addoption(parser: pytest.Parser, pluginmanager: pytest.PytestPluginManager) -> None:
    """Unload pytest-qt where Qt cannot be imported: it would end the whole run."""
    if system_requirements.missing_qt():
        pluginmanager.unregister(name="pytest-qt")
        pluginmanager.set_blocked("pytest-qt")


def pytest_configure() -> None:
    """Let Ctrl-C interrupt: a process that a shell has started in the background ignores it, and
    tests send it to themselves and to processes that they start.
    """
    if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
        signal.signal(signal.SIGINT, signal.default_int_handler)


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Mark tests by the fixtures that they use, before ``-m`` selects by marks."""
    for item in items:
        for fixture, need in NEEDED_BY_FIXTURE.items():
            if fixture in getattr(item, "fixturenames", ()):
                item.add_marker(pytest.mark.needs(need))
        if "chromium" in needs(item):
            item.add_marker(pytest.mark.browser)
        if "window" in needs(item):
            item.add_marker(pytest.mark.slow)


def pytest_collection_finish(session: pytest.Session) -> None:
    """Compile kernels before the first test: on a slow machine this exceeds a test's time limit.

    Of several processes that are about to test, one compiles and the others wait.
    """
    needing = (HERE / "agent", HERE / "app")
    if session.config.option.collectonly or not any(
        item.path.is_relative_to(folder) for item in session.items for folder in needing
    ):
        return
    from compiled_kernels import prepare

    reporter = session.config.pluginmanager.get_plugin("terminalreporter")
    prepare(reporter.write_line if reporter else lambda line: None)


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_auto_num_workers() -> int:
    """How many processes ``-n auto`` starts.

    One where windows of several would take the focus from each other on a screen that they share.
    """
    if shutil.which("Xvfb") is None and not system_requirements.missing_display():
        return 1
    try:
        cores = len(os.sched_getaffinity(0))
    except AttributeError:  # Windows, macOS
        cores = os.cpu_count() or 1
    return min(cores, MOST_WORKERS)


def needs(item: pytest.Item) -> list[str]:
    """The names in all ``needs`` markers of a test."""
    return [name for mark in item.iter_markers("needs") for name in mark.args]


def pytest_runtest_setup(item: pytest.Item) -> None:
    """Skip the test if something that it needs is missing."""
    for name in needs(item):
        reason = system_requirements.MISSING[name]()
        if reason:
            pytest.skip(reason)


@pytest.fixture(scope="session")
def qapp_args(pytestconfig: pytest.Config) -> list[str]:
    """Arguments of the QApplication: without a display it runs on Qt's offscreen platform."""
    arguments = [pytestconfig.getini("qt_qapp_name")]
    if system_requirements.missing_display():
        arguments += ["-platform", "offscreen"]
    return arguments


if system_requirements.missing_qt():

    @pytest.fixture(scope="session")
    def qapp() -> None:
        """Stands in for pytest-qt's fixture: tests that use it are skipped before."""

    @pytest.fixture
    def qtbot(qapp: None) -> None:
        """Stands in for pytest-qt's fixture: tests that use it are skipped before."""
