"""Opening, saving, recovery, and new meshes."""
