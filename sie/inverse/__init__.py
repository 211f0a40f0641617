"""Profiles for a wanted pressure."""
