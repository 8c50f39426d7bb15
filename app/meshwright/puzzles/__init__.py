"""Levels: meshes to bring to a goal in few operations, and how they are played."""
