"""Makes the environments known to Gymnasium; found by its plugin mechanism, cheap to import."""

import gymnasium

TRIANGLES, QUADS = "meshwright/Triangles-v0", "meshwright/Quads-v0"


def register_environments() -> None:
    """Register both environments, once."""
    for name, kind in ((TRIANGLES, "tri"), (QUADS, "quad")):
        if name not in gymnasium.registry:
            gymnasium.register(
                name, entry_point="agent.environment:MeshEnvironment", kwargs={"kind": kind}
            )
