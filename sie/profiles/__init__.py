"""Indenter profiles h(x) and their slopes."""
