"""Seeded meshes with one defect each, the truth beside them, and how an estimate is judged.

`catalogue` lists and builds them, `judgement` scores what an estimator says of them.
"""
