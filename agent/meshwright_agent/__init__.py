"""Reinforcement learning on meshes: environments, policy, training, search and evaluation.

Importing it registers the Gymnasium environments :data:`TRIANGLES` and :data:`QUADS`. It depends on
meshwright_core, PyTorch and Gymnasium, but neither on Qt nor on the application.
"""

# some 20 ms once PyTorch is loaded, 45 ms before: cheap enough to need no lazy registration
from meshwright_agent.registration import QUADS, TRIANGLES

__all__ = ["QUADS", "TRIANGLES"]
