"""Speed against accuracy: who takes part, who is on the front, which one to take, and its chart.

`measure`, `points`, `front`, `race`, `data`, `drawing` and `page` do not know what is compared;
`contestants`, `measuring`, `known` and `unknown` compare curvature estimators; `shaders`,
`gathering`, `shading`, `ranges`, `strip` and `sections` compare shading models.
"""
