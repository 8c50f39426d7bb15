"""The canvas: view of the mesh, overlay, mouse input and drag gestures."""
