"""Levels: dialog, bar and stars."""
