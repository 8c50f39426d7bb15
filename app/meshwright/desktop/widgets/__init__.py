"""Widgets and texts that several packages of the window use."""
