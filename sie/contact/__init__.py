"""From a load to the edges of the contact and its pressure."""
