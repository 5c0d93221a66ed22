"""Settings for all tests."""

from hypothesis import settings

# The first call of a compiled function compiles; no example may fail for that, or for a busy
# machine.
settings.register_profile("curvelight", deadline=None)
settings.load_profile("curvelight")
