"""The problem as values: materials, scenes, load paths."""
