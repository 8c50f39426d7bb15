"""The parts of the table of actions, one module a topic; :mod:`app.desktop.actions` joins them."""
