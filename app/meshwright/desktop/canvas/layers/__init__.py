"""Layers of the overlay, one kind of mark per module."""
