"""Load what the window will need later, a little at a time. Knows no Qt."""

from collections.abc import Callable, Iterator
from functools import partial
from importlib import import_module

# In an order that makes steps small: the last one is made of those before it. Loaded late they
# would keep a person waiting at the first colour difference, colour map or choice of a model.
_PACKAGES = (
    "scipy.spatial",
    "scipy.optimize",
    "scipy.interpolate",
    "scipy.ndimage",
    "matplotlib.pyplot",
    "mpl_toolkits.mplot3d",
    "colour",
)


def steps() -> Iterator[Callable[[], object]]:
    """Return what can be loaded ahead, once the first picture stands.

    Yields
    ------
    callable
        Loads a part; takes nothing, and some tenths of a second at most.
    """
    for name in _PACKAGES:
        yield partial(import_module, name)
    from lutcore.diffusion import profile_registry
    from lutcore.estimation import estimator_registry
    from lutcore.shading import model_registry

    for registry in (model_registry, profile_registry, estimator_registry):
        for name in registry.names():
            yield partial(registry.get, name)
