"""Messages between the widget in Python and in the browser."""
