"""Makes ready what an agent compiles, so that nobody waits for it in the middle of their work.

`python -m meshwright_agent.warm_up` does so in a process of its own, whose cache others then load.
Nothing heavy is imported before it is needed: the window asks here whether there is anything to do.
"""

from __future__ import annotations

from meshwright_core.core.compilation import cache_folder

_MARK = "warm"


def is_warm_on_disk() -> bool:
    """Whether :func:`warm` has run to its end for these very sources on this machine."""
    return (cache_folder("meshwright_agent") / _MARK).exists()


def warm() -> None:
    """Compile, or load from the cache, what runs and searches need, for both kinds of mesh."""
    import numpy as np

    from meshwright_agent.policy.policy_files import load, shipped
    from meshwright_agent.policy.rollout import Runner
    from meshwright_agent.search.solver import prepare
    from meshwright_core.domains.meshing import benchmark_mesh

    for kind in ("quad", "tri"):
        policy = load(shipped(kind)[0])
        Runner(benchmark_mesh(kind, 8, np.random.default_rng(0)), policy, 0).step()
        prepare(policy)
    try:
        cache_folder("meshwright_agent").mkdir(parents=True, exist_ok=True)
        (cache_folder("meshwright_agent") / _MARK).touch()
    except OSError:
        return  # a read-only home: each process compiles for itself


if __name__ == "__main__":
    from meshwright_agent.policy.policy_files import decide_on_one_thread

    decide_on_one_thread()
    warm()
