"""Speed against accuracy: who takes part, who is on the front, which one to take, and its chart.

`points`, `front`, `race`, `data`, `drawing` and `page` do not know what is compared; `contestants`,
`measuring`, `known` and `unknown` compare curvature estimators.
"""
