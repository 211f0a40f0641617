"""Readers of the files that finite-element codes write, one format a module."""
