"""Partial slip of dissimilar bodies, both equations coupled."""
