"""Score, irregularities and element quality."""
