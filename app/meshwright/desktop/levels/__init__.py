"""Levels in the window."""
