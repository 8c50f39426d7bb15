"""Messages between the widget in Python and its page."""
