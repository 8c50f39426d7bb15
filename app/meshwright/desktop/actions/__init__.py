"""The table of user actions, one module per menu; :mod:`meshwright.desktop.actions.registry` joins
them.
"""
