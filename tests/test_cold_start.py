"""After one warm-up in an empty cache, fresh processes compile no kernel."""

import json
import shutil
from pathlib import Path

import compiled_kernels
import pytest

from meshwright_agent import warm_up

COUNT = """
import json
import sys
from meshwright_core.core.linking import kernels


def print_compiled():
    modules = [sys.modules[name] for name in sorted(sys.modules) if name.startswith("meshwright")]
    print(json.dumps([
        kernel.py_func.__qualname__ for module in modules for kernel in kernels(module)
        if kernel._parts or kernel._cache_misses
    ]))
"""

USES = """
import numpy as np
import meshwright
from meshwright.cli import main
from meshwright_agent.policy.explanation import hints
from meshwright_agent.policy.policy_files import load, shipped
from meshwright_agent.policy.rollout import Runner
from meshwright_agent.search.patchwise import improve_large
from meshwright_agent.search.region_search import solve_within
from meshwright_agent.search.solver import solve
from meshwright_core import write
from meshwright_core.blocks.grid import block_grid
from meshwright_core.blocks.sizing import Sizing, WallLayer
from meshwright_core.domains.meshing import benchmark_mesh

with open("plate.svg", "w") as file:
    file.write(
        '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 100 60"><path fill-rule="evenodd" '
        'd="M0 0H100V60H0ZM40 30A10 10 0 1 0 60 30A10 10 0 1 0 40 30Z"/></svg>'
    )
for kind in ("quad", "tri"):
    policy = load(shipped(kind)[0])
    mesh = benchmark_mesh(kind, 10, np.random.default_rng(1))
    large = benchmark_mesh(kind, 40, np.random.default_rng(1))
    write("start.vtk", mesh)
    assert main(["improve", "start.vtk", "-o", "end.vtk", "--rollouts", "1", "--json"]) == 0
    solve(mesh, policy, seconds=0.5)
    hints(mesh, policy)
    runner = Runner(mesh, policy, seed=0)
    runner.look()
    runner.step()
    solve_within(large, policy, large.element_ids()[:20], seconds=0.5)
    improve_large(large, policy, max_steps=60)
    meshwright.solve(mesh, seconds=0.5)
    plate = ["improve", "plate.svg", "-o", "plate.vtk", "--kind", kind, "--search", "2"]
    assert main(plate) == 0
    if kind == "quad":
        assert main([*plate, "--elements-shape", "0.3"]) == 0
        block_grid(mesh, Sizing(divide=11, walls=(WallLayer("all", 1e-3),)))
print_compiled()
"""

CORE = """
import numpy as np
from meshwright.document.document import Document
from meshwright.document.operation_preview import choices, ghost
from meshwright.document.shape_change import shape_change
from meshwright.graphics.mesh_figure import figure
from meshwright_core import warm_up
from meshwright_core.domains import gallery, meshing
from meshwright_core.geometry import quality
from meshwright_core.operations.catalogue import of_kind

warm_up.exercise()
for name, kind in (("star", "tri"), ("star", "quad"), ("two-materials", "quad")):
    mesh = meshing.mesh_domain(gallery.shape(name), kind)
    document = Document(mesh, name)
    for info in of_kind(kind):
        for h in range(4 * mesh.n_elements):
            if mesh.live(h) and mesh.check(info.operation, h):
                choices(mesh, h)
                ghost(mesh, info.operation, h)
                if info.is_local:
                    shape_change(mesh, info.operation, h)
                document.submit(info.operation, h)
                break
    movable = mesh.vertices()[~mesh.geometric()[mesh.vertices()]]
    for vertex in (movable[mesh.boundary()[movable]], movable[~mesh.boundary()[movable]]):
        document.move(vertex[:1], mesh.points[vertex[:1]] + 0.01)
    document.smooth()
    document.go_to(0)
    quality.scaled_jacobian(mesh)
    figure(mesh)
print_compiled()
"""


def output(code: list[str], cache: Path, folder: Path) -> str:
    """What Python prints that runs with the kernels in `cache`."""
    done = compiled_kernels.run(code, cache, folder)
    assert done.returncode == 0, done.stderr
    return done.stdout


@pytest.fixture(scope="module")
def cache(tmp_path_factory):
    """A cache that the warm-up of the agent has filled."""
    folder = tmp_path_factory.mktemp("kernels")
    kept = compiled_kernels.kept(compiled_kernels.AGENT)
    if kept:
        shutil.copytree(kept, folder, dirs_exist_ok=True)
    else:
        output(["-m", "meshwright_agent.warm_up"], folder, folder)
    return folder


@pytest.mark.slow
@pytest.mark.timeout(900)
def test_the_agent_compiles_nothing_after_its_warm_up(cache, tmp_path):
    entry_points = len(list(cache.rglob("*.nbi")))
    compiled = output(["-c", COUNT + USES], cache, tmp_path)
    assert json.loads(compiled.splitlines()[-1]) == []
    assert len(list(cache.rglob("*.nbi"))) == entry_points == warm_up.ENTRY_POINTS


@pytest.mark.slow
@pytest.mark.timeout(900)
def test_the_editor_compiles_nothing_after_its_warm_up(cache, tmp_path):
    kept = compiled_kernels.kept(compiled_kernels.EDITOR)
    folder = shutil.copytree(kept or cache, tmp_path / "kernels")
    output(["-m", "meshwright_core.warm_up"], folder, tmp_path)
    compiled = output(["-c", COUNT + CORE], folder, tmp_path)
    assert json.loads(compiled.splitlines()[-1]) == []
