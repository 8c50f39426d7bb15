"""Runs a policy on a document, in a separate thread."""
