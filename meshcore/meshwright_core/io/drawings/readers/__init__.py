"""Readers of drawings, one module a format: the curves that a file holds."""
