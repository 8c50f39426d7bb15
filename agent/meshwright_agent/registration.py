"""Makes the environments known to Gymnasium when it is imported, which is cheap.

``gymnasium.make("meshwright_agent.registration:meshwright/Quads-v0")`` imports it by itself.
"""

import gymnasium

TRIANGLES, QUADS = "meshwright/Triangles-v0", "meshwright/Quads-v0"

for _name, _kind in ((TRIANGLES, "tri"), (QUADS, "quad")):
    gymnasium.register(
        _name, entry_point="meshwright_agent.env.gym_env:MeshEnvironment", kwargs={"kind": _kind}
    )
