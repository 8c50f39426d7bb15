"""Blocks of a quad mesh: the view with chords and the fine grid, and the export of grids."""
