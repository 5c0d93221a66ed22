"""Curvature estimators."""
