"""The arrays of a half-edge mesh: layout, invariants, construction, circulation, validation."""
