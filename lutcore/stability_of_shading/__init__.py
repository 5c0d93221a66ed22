"""Where shading models fail: on bodies whose truth is known, over curvature, material and light.

`bodies` makes the inputs, `distance` measures errors over the distance that light goes, `maps` over
all three, `noise`, `seams` and `limits` look at what else can break.
"""
