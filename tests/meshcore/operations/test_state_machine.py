"""A hypothesis state machine: random operations on random meshes against the naive face list."""

import numpy as np
import pytest
from hypothesis import HealthCheck, settings
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, initialize, invariant, rule

from meshwright_core import HalfEdgeMesh, OperationRefused
from meshwright_core.testing.comparison import Comparison, face_list
from meshwright_core.testing.face_list_rewrites import allowed, apply
from meshwright_core.testing.fuzzing import agree, snapshot, start_mesh

pytestmark = pytest.mark.slow


class _Machine(RuleBasedStateMachine):
    kind = "tri"

    @initialize(
        seed=st.integers(0, 2**32 - 1),
        size=st.integers(3, 9),
        cap=st.sampled_from([0, 7]),
        curved=st.booleans(),
        interfaces=st.booleans(),
    )
    def begin(self, seed, size, cap, curved, interfaces):
        self.rng = np.random.default_rng(seed)
        self.mesh: HalfEdgeMesh = start_mesh(self.kind, size, self.rng, curved, interfaces)
        self.both = Comparison(self.mesh, face_list(self.mesh))
        self.delta_sum, self.euler = self.both.oracle.delta_sum(), self.mesh.euler
        self.optimum = self.mesh.optimum
        self.history = [snapshot(self.mesh)]
        self.redone = []

    @rule(pick=st.integers(0, 10**6), name=st.integers(0, 6))
    def operate(self, pick, name):
        names = list(self.mesh.allowed(-1))
        operation = names[name % len(names)]
        ids = self.mesh.element_ids()
        h = int(ids[pick % len(ids)]) * self.mesh.k + (pick // 7919) % self.mesh.k
        a, b = self.mesh.origin(h), self.mesh.target(h)
        before = snapshot(self.mesh)
        verdict = self.mesh.check(operation, h)
        assert agree(before, snapshot(self.mesh)), "check had a side effect"
        if not verdict:
            needless = allowed(self.both.oracle, str(operation), a, b)
            assert not needless, f"{operation} {a}-{b} was refused: {verdict.reason}"
            try:
                self.mesh.apply(operation, h)
            except OperationRefused as error:
                assert verdict.reason in str(error)
            assert agree(before, snapshot(self.mesh)), "a refused edit left a trace"
            return
        score = self.mesh.score
        edit = self.mesh.apply(operation, h)
        assert self.mesh.score == score + edit.score_change
        self.both.step(apply(self.both.oracle, str(operation), a, b, edit.new_vertices))
        self.history.append(snapshot(self.mesh))
        self.redone.clear()

    @rule(count=st.integers(1, 5))
    def undo(self, count):
        for _ in range(min(count, len(self.history) - 1)):
            assert self.mesh.undo()
            self.redone.append(self.history.pop())
            assert agree(self.history[-1], snapshot(self.mesh)), "undo is not exact"
        self.both = Comparison(self.mesh, face_list(self.mesh))

    @rule()
    def redo(self):
        assert self.mesh.can_redo == bool(self.redone)
        if self.redone:
            assert self.mesh.redo()
            self.history.append(self.redone.pop())
            assert agree(self.history[-1], snapshot(self.mesh)), "redo is not exact"
            self.both = Comparison(self.mesh, face_list(self.mesh))

    @invariant()
    def holds(self):
        if hasattr(self, "mesh"):
            self.both.whole()
            assert self.both.oracle.delta_sum() == self.delta_sum
            assert self.mesh.optimum == self.optimum >= abs(self.delta_sum)
            assert self.mesh.euler == self.euler == self.both.oracle.euler()


class _Quads(_Machine):
    kind = "quad"


_SETTINGS = settings(
    max_examples=30,
    stateful_step_count=40,
    deadline=None,
    suppress_health_check=list(HealthCheck),
)
TestTriangles = _Machine.TestCase
TestTriangles.settings = _SETTINGS
TestQuads = _Quads.TestCase
TestQuads.settings = _SETTINGS
