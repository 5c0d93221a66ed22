"""Volumetric Monte Carlo: light followed from collision to collision through convex bodies.

The truth that shading models are measured against. `bodies` says where light can be, `boundary`
what happens at the surface, `photons` follows one, `exitance` counts them. Lengths are in units of
the mean free path l_u of the channel.
"""
