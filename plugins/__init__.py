"""Plug-ins: one published method, one file."""
