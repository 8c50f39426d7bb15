"""Sources of meshes: names and paths, polygons drawn by hand, meshing in a separate process."""
