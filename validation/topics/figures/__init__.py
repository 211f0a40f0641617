"""The figures of the topics, each drawn from its records."""
