"""The half-edge mesh and all that changes it. Knows neither torch nor Qt."""
