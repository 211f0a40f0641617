"""Every claim of the project, computed anew by `python -m validation`; see `__main__`."""
