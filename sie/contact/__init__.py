"""The edges of the contact and its pressure under a load."""
