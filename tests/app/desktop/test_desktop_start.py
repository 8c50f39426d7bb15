"""What is imported and compiled before the first paint, measured in a separate process."""

import pytest

from meshwright.benchmarks import desktop
from meshwright.benchmarks.desktop.display import display
from meshwright_core import warm_up

pytestmark = pytest.mark.slow


@pytest.mark.needs("window")
def test_first_paint_needs_neither_torch_nor_kernels():
    warm_up.warm()
    with display() as environment:
        started = desktop._probe("start", environment)
    assert not started["torch_at_first_paint"]
    assert not started["torch_at_the_end"]
    assert not started["compiled_at_first_paint"]
    assert started["first_paint_s"] < started["mesh_drawn_s"] < started["kernels_ready_s"]
    assert started["first_paint_s"] < 15  # 0.6 here; a loaded machine is no failure
