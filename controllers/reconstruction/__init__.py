"""Whole bodies from a few points: motion databases, local regression and the pose that explains the points best (Mousas 2014)."""
