"""Finds the regions that the curves of a drawing enclose: gaps, crossings, network, faces."""
