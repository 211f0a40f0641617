"""Many scenes: a grid of parameters, its work in chunks, and the labelled result."""
