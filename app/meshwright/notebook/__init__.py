"""The notebook widget: an editor for a document in the browser, driven from Python."""

from meshwright.notebook.widget import MeshWidget

__all__ = ["MeshWidget"]
