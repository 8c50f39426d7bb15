"""Analyses of a mesh: blocks, removable lines, submeshes, drawability, dry runs."""
