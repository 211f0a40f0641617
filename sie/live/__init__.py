"""The live page: one contact under sliders, served on this machine or saved with its answers."""
