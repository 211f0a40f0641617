"""References in many digits, or by another method, that tests and validation share.

Nothing here imports `sie` or `analytic`: an answer of theirs is compared with what other formulas
give. The precision is that of a context of its own in each module; mpmath's global one stays.
"""
