"""The per-pixel path: a shading model in the fragment shader, for a window whose lights move.

It draws what `app.picture.compose` gives at vertices, computed at each pixel instead. Pictures
that are saved never come from here.
"""
