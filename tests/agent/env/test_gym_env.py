"""The Gymnasium environment."""

import subprocess
import sys

import gymnasium
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env

from meshwright_agent import QUADS, TRIANGLES
from meshwright_core import MeshError
from meshwright_core.domains.meshing import benchmark_mesh


@pytest.mark.parametrize("name", [TRIANGLES, QUADS])
@pytest.mark.filterwarnings("error")
def test_passes_the_checker(name):
    check_env(gymnasium.make(name).unwrapped, skip_render_check=True)


@pytest.mark.parametrize(
    "code",
    [
        "import gymnasium; gymnasium.make('meshwright_agent:meshwright/Quads-v0')",
        "import meshwright_agent, gymnasium; gymnasium.make('meshwright/Triangles-v0')",
        "import meshwright_agent as a, gymnasium; gymnasium.make(f'meshwright_agent:{a.QUADS}')",
    ],
)
def test_is_registered_by_importing_the_package(code):
    subprocess.run([sys.executable, "-c", code], check=True)


def test_importing_the_package_does_not_import_the_environments():
    code = "import sys, meshwright_agent; print({'torch', 'numba'} & set(sys.modules))"
    done = subprocess.run([sys.executable, "-c", code], check=True, capture_output=True, text=True)
    assert done.stdout.strip() == "set()"


@pytest.mark.parametrize("name", [TRIANGLES, QUADS])
def test_rewards_add_up_to_the_change_of_score(name):
    env = gymnasium.make(name, sides=(10, 12))
    rng = np.random.default_rng(0)
    _, info = env.reset(seed=3)
    start, total, over = info["score"], 0.0, False
    while not over:
        action = rng.choice(np.flatnonzero(info["action_mask"]))
        observation, reward, terminated, truncated, info = env.step(action)
        total += reward
        over = terminated or truncated
        assert terminated == (info["score"] == info["optimum"])
    assert total == start - info["score"]
    assert env.observation_space.contains(observation)
    env.unwrapped.mesh.validate()


def test_a_forbidden_action_changes_nothing():
    env = gymnasium.make(QUADS)
    _, info = env.reset(seed=1)
    forbidden = np.flatnonzero(info["action_mask"] == 0)[0]
    _, reward, _, _, after = env.step(forbidden)
    assert reward == 0 and after["score"] == info["score"]


def test_starts_from_a_given_mesh():
    mesh = benchmark_mesh("quad", 12, np.random.default_rng(8))
    env = gymnasium.make(QUADS)
    _, info = env.reset(options={"mesh": mesh})
    assert info["score"] == mesh.score
    env.step(np.flatnonzero(info["action_mask"])[0])
    assert mesh.steps == 0


def test_refuses_a_mesh_of_the_other_kind():
    triangles = benchmark_mesh("tri", 12, np.random.default_rng(8))
    env = gymnasium.make(QUADS)
    with pytest.raises(MeshError, match="edits quads, but the mesh is of triangles"):
        env.reset(options={"mesh": triangles})
    with pytest.raises(TypeError, match="must be a HalfEdgeMesh, not str"):
        env.reset(options={"mesh": "star.vtk"})


def test_the_same_seed_gives_the_same_run():
    runs = []
    for _ in range(2):
        env = gymnasium.make(TRIANGLES)
        _, info = env.reset(seed=11)
        scores = []
        for _ in range(20):
            _, _, _, _, info = env.step(np.flatnonzero(info["action_mask"])[-1])
            scores.append(info["score"])
        runs.append(scores)
    assert runs[0] == runs[1]
