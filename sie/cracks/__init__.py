"""Cracks normal to the surface: stress intensity, closure, arrest."""
