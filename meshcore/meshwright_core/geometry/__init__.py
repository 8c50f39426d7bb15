"""Positions: outline, sides, element quality, smoothing and untangling."""
