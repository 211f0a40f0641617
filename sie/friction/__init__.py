"""Stick, slip and the memory of the load history."""
