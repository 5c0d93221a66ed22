"""Shading models: one published method, one file."""
