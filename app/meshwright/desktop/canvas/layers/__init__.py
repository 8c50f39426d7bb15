"""What the overlay paints over the mesh, one layer a module."""
