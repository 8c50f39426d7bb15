"""Project files, autosave and recovery."""
