"""Where Qt cannot be imported, the modules of this folder cannot be either: each is skipped."""

from pathlib import Path

import pytest
import system_requirements


class WithoutQt(pytest.Module):
    """A test module that is not imported."""

    def collect(self) -> list[pytest.Item]:
        pytest.skip(system_requirements.missing_qt(), allow_module_level=True)


def pytest_pycollect_makemodule(module_path: Path, parent: pytest.Collector) -> WithoutQt | None:
    if system_requirements.missing_qt():
        return WithoutQt.from_parent(parent, path=module_path)
    return None
