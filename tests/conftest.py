"""Settings for all tests."""

import pytest
from hypothesis import settings

# The first call of a compiled function compiles; no example may fail for that, or for a busy
# machine.
settings.register_profile("curvelight", deadline=None)
settings.load_profile("curvelight")


@pytest.fixture(autouse=True)
def _compile_quietly(monkeypatch: pytest.MonkeyPatch) -> None:
    """Keep the remark on compiling out of what commands print here, warm or cold."""
    monkeypatch.setattr("app.cli.main.when_compiling", lambda listener: None)
