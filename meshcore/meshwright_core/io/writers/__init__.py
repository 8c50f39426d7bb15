"""Writers of mesh formats that hold names: each returns the text of the whole file."""
