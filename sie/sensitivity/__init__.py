"""Exact derivatives of a solution by the numbers of its scene."""
