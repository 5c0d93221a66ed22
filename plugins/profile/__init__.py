"""Diffusion profiles: one published method, one file."""
