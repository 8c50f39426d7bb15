"""Domains to mesh: the gallery, random polygons and parts; and how they are meshed."""
