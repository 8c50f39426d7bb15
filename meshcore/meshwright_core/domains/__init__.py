"""Domains (gallery, random polygons, random parts) and their meshing."""
