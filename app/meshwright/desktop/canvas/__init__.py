"""The canvas: mouse, gestures, and the overlay painted on the picture."""
