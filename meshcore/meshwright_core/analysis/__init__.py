"""What can be read off a mesh: blocks, removable lines, submeshes, drawability."""
