"""Runs a policy on a document, in a thread of its own."""
