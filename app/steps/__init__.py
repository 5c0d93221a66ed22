"""The steps from a session to per-vertex arrays, each upon the ones before; see `app.pipeline`."""
