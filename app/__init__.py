"""Document, desktop window, command line."""
