"""Pages, images and recordings of a widget."""
