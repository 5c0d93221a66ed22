"""Volume scans (CT, MR) as surfaces: found by content, read in a guarded child process."""

from app.volume.loader import load_surface
from app.volume.source import Source, source_of

__all__ = ["Source", "load_surface", "source_of"]
