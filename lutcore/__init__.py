"""Curvature of triangle meshes and translucent shading from it: arrays in, arrays out.

Names are imported when they are first used, so that ``import lutcore`` costs nothing.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
