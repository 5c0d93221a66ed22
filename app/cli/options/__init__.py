"""Flags that commands share, and the session they add up to."""
