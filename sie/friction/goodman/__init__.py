"""Partial slip of dissimilar bodies by Goodman's approximation."""
