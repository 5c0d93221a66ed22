"""Meshes from files: whatever a file holds, a checked mesh or one clear error comes back."""

from app.loading.errors import UnreadableFileError
from app.loading.loader import LoadedMesh, load_mesh

__all__ = ["LoadedMesh", "UnreadableFileError", "load_mesh"]
