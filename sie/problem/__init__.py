"""What is asked, as values: materials, scenes, load paths."""
