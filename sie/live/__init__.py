"""The live page: one contact under sliders, served on this machine or saved with its answers.

It asks the solver as users do, by the public names of `sie`.
"""
