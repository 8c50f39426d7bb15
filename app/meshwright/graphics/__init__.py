"""Theme, viewport, markers and figures, shared by window, notebook and files."""
