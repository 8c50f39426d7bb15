"""Curves of drawings: segments, arcs and splines, exact at every point."""
