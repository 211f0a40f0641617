"""Readers of what finite-element codes write."""
