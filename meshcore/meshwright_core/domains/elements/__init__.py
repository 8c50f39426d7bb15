"""Triangles and quads between the sides of a domain: coarse and refined starts of meshes."""
