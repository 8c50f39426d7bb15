"""Files of drawings as the tests write them."""

from collections.abc import Callable

import pytest

from meshwright_core import MeshError
from meshwright_core.io import drawings
from meshwright_core.io.drawings import DrawingReport


@pytest.fixture
def found(tmp_path) -> Callable[..., DrawingReport]:
    """Write a file and find its regions."""

    def read(name: str, content: str | bytes, **options) -> DrawingReport:
        path = tmp_path / name
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
        return drawings.read_regions(path, **options)

    return read


@pytest.fixture
def sentence(found) -> Callable[..., str]:
    """Read a file that is bad; return the sentence."""

    def read(name: str, content: str | bytes, **options) -> str:
        with pytest.raises(MeshError) as error:
            found(name, content, **options)
        message = str(error.value)
        assert name in message and "\n" not in message and message.endswith(".")
        return message

    return read
