"""The parts of the table of actions, one module a topic; :mod:`meshwright.desktop.actions.registry`
joins them.
"""
