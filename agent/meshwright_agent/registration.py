"""Registers the environments with Gymnasium; runs when ``meshwright_agent`` is imported.

The environment class itself is imported by ``gymnasium.make`` when it creates one.
"""

import gymnasium

TRIANGLES, QUADS = "meshwright/Triangles-v0", "meshwright/Quads-v0"

for _name, _kind in ((TRIANGLES, "tri"), (QUADS, "quad")):
    gymnasium.register(
        _name, entry_point="meshwright_agent.env.gym_env:MeshEnvironment", kwargs={"kind": _kind}
    )
