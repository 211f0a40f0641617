"""One contact under a path of loads: histories, and the steady state of cycles."""
