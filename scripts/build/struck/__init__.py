"""Fits how people answer pushes, and how they fall and get up, to recordings."""
