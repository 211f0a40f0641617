"""Dissimilar bodies (beta != 0): one name for a family of modules.

Pressure and shear traction act on each other.

    full sliding, q = f p, `coupling` = beta f, signed as the sliding:
        dissimilar.sliding_hertz, .sliding_flat, .sliding_rounded_flat
    full stick under P, Q and M, `dundurs` = beta:
        dissimilar.bonded_flat

>>> from analytic import dissimilar
>>> x1, x2 = dissimilar.sliding_hertz.edges(half_width=1.0, coupling=0.0)
>>> float(x1), float(x2)
(-1.0, 1.0)
"""

from analytic import bonded_flat, sliding_flat, sliding_hertz, sliding_rounded_flat

__all__ = ["bonded_flat", "sliding_flat", "sliding_hertz", "sliding_rounded_flat"]
