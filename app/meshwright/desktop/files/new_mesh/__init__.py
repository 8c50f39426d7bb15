"""The dialog for new meshes: gallery, random shapes, drawing, files; with a live preview."""

from meshwright.desktop.files.new_mesh.dialog import NewMeshDialog

__all__ = ["NewMeshDialog"]
