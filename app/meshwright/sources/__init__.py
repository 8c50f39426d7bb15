"""What a name or a path means, polygons drawn by hand, and meshing in a process of its own."""
