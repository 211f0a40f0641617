"""Closed forms of plane elastic contact, as plain functions of floats, arrays or mpmath numbers.

A rigid indenter, or one of the half-plane's own kind, is pressed without friction on an elastic half-plane y > 0.
Each module is one indenter. All speak one notation:

    word in a call    symbol      meaning
    x                 x           position on the surface
    y                 y           depth below the surface
    z                 z = x + iy  point of the plane; the body is y > 0
    normal_load       P           ∫ p dx, load per unit length, > 0
    moment            M           ∫ p x dx, moment per unit length about x = 0
    modulus           E*          1/E* = (1-nu1²)/E1 + (1-nu2²)/E2
    half_width        b           the contact is [-b, b]
    half_flat         a           half the flat part of the indenter, a <= b
    rim               b - a       for thin rims, which b - a taken from b would not resolve
    radius            R           radius of the curved part
    slope             A           of a wedge, h = A |x|
    exponent          m           of a power form, h = C |x|^m
    coefficient       C
    tilt              h'          rotation of a flat
    pressure          p >= 0      sigma_yy = -p on the surface
    height, slope     h, h'       gap between the undeformed surfaces, growing away from the contact
    potential         Fp          (1/pi) ∫ p(t)/(z-t) dt; on the contact, side = +1, it is E*/2 h' - i p
    friction          f           of full sliding, q = f p
    xx, yy, xy        s_ij        stress, tension positive: s_yy = -p, s_xy = -q on the surface
    side              ±           +1: the limit from y > 0; -1: from y < 0
    lib                           numpy (arrays broadcast) or an mpmath context (scalars at its own precision)

Any consistent set of units will do: nothing depends on scale.

    >>> from analytic import rounded_flat
    >>> float(round(rounded_flat.load(half_flat=0.5, half_width=1.0, radius=1.0, modulus=1.0), 12))
    0.307092424652
"""

from analytic import flat, hertz, interior, power, rounded_flat, wedge

__all__ = ["flat", "hertz", "interior", "power", "rounded_flat", "wedge"]
