"""The Markov decision process as a Gymnasium environment: one mesh, one operation per step."""

from __future__ import annotations

from typing import Any

import gymnasium
import numpy as np
from gymnasium import spaces

from meshwright_agent.env.candidates import gather, masks
from meshwright_agent.env.local_patch import POTENTIALS, describe
from meshwright_agent.env.potential import forget, solve_potential
from meshwright_agent.env.task import Scratch, Task, choose_candidates, transition
from meshwright_core.core.arrays import JOURNALLING
from meshwright_core.core.compilation import bare_kernel
from meshwright_core.core.kinds import KIND_NOUN
from meshwright_core.domains.meshing import benchmark_mesh
from meshwright_core.errors import MeshError
from meshwright_core.mesh import HalfEdgeMesh


@bare_kernel
def _describe_templates(m, chosen, k, source, turn, slots, field, out):
    """Write the channels (K, T, C) of the templates of K candidates; 0 beyond the boundary."""
    solved = out.shape[2] > POTENTIALS
    elements = solve_potential(m, k, chosen, field) if solved else 0
    for i in range(len(chosen)):
        if chosen[i] < 0:
            out[i] = 0
            continue
        gather(m, chosen[i], k, source, turn, slots)
        for j in range(len(slots)):
            if slots[j] < 0:
                out[i, j] = 0
            else:
                describe(m, slots[j], k, field, out[i, j])
    forget(m, k, field, elements)


class MeshEnvironment(gymnasium.Env[dict[str, np.ndarray], np.int64]):
    """Edit a mesh until its vertices have their desired degrees (section 4).

    Actions: ``Discrete(K * A)``; i * A + a is operation a at candidate half-edge i. The K
    candidates are selected anew at each step (:mod:`meshwright_agent.env.candidates`). An action
    that the mask forbids leaves the mesh as it is and uses up a step.

    Observation: ``template`` (K, T, C) int8, the channels
    (:data:`meshwright_agent.env.local_patch.CHANNELS`) of the T half-edges of each candidate's
    template; ``mask`` (K, A) int8, 1 where an operation is permitted; ``changes`` (K, A) int8, the
    exact change of s of each permitted operation; ``state`` (3,) float32, (s - s*) / 10, the share
    of steps left, and the elements relative to the start.

    Reward: s before less s after the step (equation 4).

    Episode end: terminated at the optimum, s = s*; truncated after a number of steps proportional
    to the elements at the start, or when no operation is permitted.

    Reset options: ``mesh``, a HalfEdgeMesh to start from in place of a random polygon.

    Info: ``score`` s, ``optimum`` s*, ``elements`` their number, ``action_mask`` (K * A,) int8 as
    ``Discrete.sample`` takes it.
    """

    metadata: dict[str, Any] = {"render_modes": []}  # noqa: RUF012 - as Gymnasium declares it

    def __init__(
        self,
        kind: str = "quad",
        sides: tuple[int, int] = (10, 30),
        task: Task | None = None,
        render_mode: str | None = None,
    ) -> None:
        """Create an environment; it has no mesh before the first reset.

        kind: "quad" or "tri". sides: least and largest number of sides of the random polygons.
        task: all settings of the task; its kind is used in place of `kind`.
        """
        if render_mode is not None:
            raise ValueError(f"render mode {render_mode!r} is not supported")
        self.render_mode = None
        self.task = task or Task(kind)
        self.sides = sides
        task = self.task
        source, _ = task.template
        shape = (task.rows, task.operations)
        self.action_space = spaces.Discrete(task.rows * task.operations)
        self.observation_space = spaces.Dict(  # type: ignore[assignment]
            {
                "template": spaces.Box(-128, 127, (task.rows, len(source), task.channels), np.int8),
                "mask": spaces.MultiBinary(shape),
                "changes": spaces.Box(-128, 127, shape, np.int8),
                "state": spaces.Box(
                    np.array([0, -1, 0], np.float32), np.array([1e6, 1, 1e3], np.float32)
                ),
            }
        )
        self._chosen = np.full(task.rows, -1, np.int64)
        self._mask = np.zeros(shape, np.bool_)
        self.mesh: HalfEdgeMesh | None = None

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[dict[str, np.ndarray], dict[str, Any]]:
        """Start from a random polygon that is not at its optimum, or from ``options["mesh"]``.

        Raises MeshError if that mesh is of the other kind, TypeError if it is no HalfEdgeMesh.
        """
        super().reset(seed=seed)
        given = (options or {}).get("mesh")
        mesh = self._draw() if given is None else self._copy_of(given)
        mesh.arrays.counters[JOURNALLING] = 0
        size = mesh.n_elements
        mesh.reserve(2 * size + 64, 2 * size + 64)
        self.mesh, self._steps = mesh, 0
        self._start_elements, self._start_score = size, mesh.score
        self._limit, self._bounds = self.task.step_limit(size), self.task.bounds(size)
        self._scratch = Scratch(self.task, len(mesh.arrays.edge), len(mesh.arrays.vertex))
        return self._observe(), self._info()

    def _copy_of(self, given: object) -> HalfEdgeMesh:
        if not isinstance(given, HalfEdgeMesh):
            raise TypeError(
                f"reset options: the mesh must be a HalfEdgeMesh, not {type(given).__name__}"
            )
        if given.kind != self.task.kind:
            raise MeshError(
                f"reset options: this environment edits {KIND_NOUN[self.task.kind]}, but the mesh"
                f" is of {KIND_NOUN[given.kind]}"
            )
        return given.copy()

    def _draw(self) -> HalfEdgeMesh:
        low, high = self.sides
        while True:
            sides = int(self.np_random.integers(low, high + 1))
            mesh = benchmark_mesh(self.task.kind, sides, self.np_random)
            if mesh.score > mesh.optimum:
                return mesh

    def _observe(self) -> dict[str, np.ndarray]:
        assert self.mesh is not None
        task, arrays, scratch = self.task, self.mesh.arrays, self._scratch
        source, turn = task.template
        rules = task.rules(*self._bounds)
        choose_candidates(arrays, rules, task.ranking, scratch.work, self._chosen, self.np_random)
        changes = np.zeros(self._mask.shape, np.int8)
        masks(arrays, self._chosen, rules, self._mask, changes)
        template = np.empty((task.rows, len(source), task.channels), np.int8)
        _describe_templates(
            arrays, self._chosen, task.k, source, turn, scratch.work.slots, scratch.field, template
        )
        state = (
            (self.mesh.score - self.mesh.optimum) / 10.0,
            1.0 - self._steps / self._limit,
            self.mesh.n_elements / self._start_elements,
        )
        return {
            "template": template,
            "mask": self._mask.astype(np.int8),
            "changes": changes,
            "state": np.array(state, np.float32),
        }

    def _info(self) -> dict[str, Any]:
        assert self.mesh is not None
        return {
            "score": self.mesh.score,
            "optimum": self.mesh.optimum,
            "elements": self.mesh.n_elements,
            "action_mask": self._mask.ravel().astype(np.int8),
        }

    def step(
        self, action: np.int64
    ) -> tuple[dict[str, np.ndarray], float, bool, bool, dict[str, Any]]:
        """Apply one operation and the clean-ups that it makes possible."""
        if self.mesh is None:
            raise gymnasium.error.ResetNeeded("reset the environment before the first step")
        before = self.mesh.score
        candidate, operation = divmod(int(action), self.task.operations)
        if self._mask[candidate, operation]:
            scratch = self._scratch
            transition(
                self.mesh.arrays, self.task.first_operation + operation, self._chosen[candidate],
                self.task.cap, scratch.touched, scratch.cleaned,
            )  # fmt: skip
        self._steps += 1
        observation = self._observe()
        terminated = self.mesh.score <= self.mesh.optimum
        truncated = not terminated and (self._steps >= self._limit or not self._mask.any())
        return observation, float(before - self.mesh.score), terminated, truncated, self._info()
