"""The agent in the window: panel, hints, controllers."""
