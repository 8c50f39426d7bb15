"""The notebook's view of a document: a widget in the browser, and Python on the other side."""

from meshwright.notebook.widget import MeshWidget

__all__ = ["MeshWidget"]
