"""The operations on half-edges: what each requires, does, and changes in the score."""
