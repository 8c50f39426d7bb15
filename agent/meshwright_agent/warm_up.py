"""Makes ready what an agent compiles, so that nobody waits for it in the middle of their work.

`python -m agent.warm_up` does so in a process of its own, whose cache others then load. Nothing
heavy is imported before it is needed: the window asks here whether there is anything to do.
"""

from __future__ import annotations

from meshcore.compiled import cache_folder

_MARK = "warm"


def is_warm_on_disk() -> bool:
    """Whether :func:`warm` has run to its end for these very sources on this machine."""
    return (cache_folder("agent") / _MARK).exists()


def warm() -> None:
    """Compile, or load from the cache, what runs and searches need, for both kinds of mesh."""
    import numpy as np

    from agent.policies import load, shipped
    from agent.rollout import Runner
    from agent.solver import prepare
    from meshcore.generate import benchmark_mesh

    for kind in ("quad", "tri"):
        policy = load(shipped(kind)[0])
        Runner(benchmark_mesh(kind, 8, np.random.default_rng(0)), policy, 0).step()
        prepare(policy)
    try:
        cache_folder("agent").mkdir(parents=True, exist_ok=True)
        (cache_folder("agent") / _MARK).touch()
    except OSError:
        return  # a read-only home: each process compiles for itself


if __name__ == "__main__":
    from agent.policies import decide_on_one_thread

    decide_on_one_thread()
    warm()
