"""Editing by mouse, keys and menus."""
