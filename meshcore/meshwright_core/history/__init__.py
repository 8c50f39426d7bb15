"""The undo journal, and steps packed for long histories."""
