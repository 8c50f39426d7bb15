"""The window itself and its parts."""
