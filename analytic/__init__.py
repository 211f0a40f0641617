"""Closed forms of plane elastic contact, as plain functions of floats, arrays or mpmath numbers.

A rigid indenter, or one of the half-plane's own kind, is pressed on an elastic half-plane y > 0.
Each module is one indenter under one kind of load:

    hertz, flat, rounded_flat, wedge, power               pressed, no friction or similar bodies
    two_flats, two_parabolas                              two patches, one load
    wavy, flat_row, parabola_row                          a row of contacts that repeats
    sliding_hertz, sliding_flat, sliding_rounded_flat     sliding, dissimilar bodies
    bonded_flat                                           no slip at all, dissimilar bodies
    cattaneo, cattaneo_rounded                            partial slip, similar bodies
    goodman, spence                                       stick zone of dissimilar bodies
    cracks                                                rows of cracks

All modules share one notation:

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
    potential         Fp          (1/pi) ∫ p(t)/(z-t) dt; on the contact, side = +1, E*/2 h' - i p
    coupling          beta f      of dissimilar bodies that slide, < 0 for shear towards -x
    dundurs           beta        Dundurs' second constant
    friction          f           Coulomb's coefficient
    shear             q           sigma_xy = -q on the surface; q > 0 pushes the body to +x
    shear_load        Q           ∫ q dx
    tangential_load   Q           the same, in partial slip; it turned at largest_load, least_load
    stick_half_width  c           of the stick zone; stick_rim = c - a, slip_width = b - c
    slip              s           of the indenter over the half-plane towards +x
    bulk_stress       sigma       tension along the surface of the half-plane
    inner, outer      a, b        ends of the patch on x > 0 (c1, c2 if they move), and its mirror
    distance          d           of the apexes from x = 0
    wavelength        lambda      of a wave of `amplitude` D, h = D (1 - cos(2 pi x/lambda))
    period            L, W        of a row
    mean_pressure                 load over period
    tension, K_I                  across cracks, and their stress intensity factor
    xx, yy, xy        s_ij        stress, tension positive: s_yy = -p, s_xy = -q on the surface
    side              ±           +1: the limit from y > 0; -1: from y < 0
    lib                           numpy (arrays broadcast) or an mpmath context (scalars)

Any consistent set of units will do: nothing depends on scale.

    >>> from analytic import rounded_flat
    >>> float(round(rounded_flat.load(half_flat=0.5, half_width=1.0, radius=1.0, modulus=1.0), 12))
    0.307092424652
"""

from analytic import (
    bonded_flat,
    cattaneo,
    cattaneo_rounded,
    cracks,
    dissimilar,
    flat,
    flat_row,
    goodman,
    hertz,
    interior,
    parabola_row,
    periodic,
    power,
    rounded_flat,
    sliding_flat,
    sliding_hertz,
    sliding_rounded_flat,
    spence,
    two_flats,
    two_parabolas,
    two_punches,
    wavy,
    wedge,
)

__all__ = [
    "bonded_flat",
    "cattaneo",
    "cattaneo_rounded",
    "cracks",
    "dissimilar",
    "flat",
    "flat_row",
    "goodman",
    "hertz",
    "interior",
    "parabola_row",
    "periodic",
    "power",
    "rounded_flat",
    "sliding_flat",
    "sliding_hertz",
    "sliding_rounded_flat",
    "spence",
    "two_flats",
    "two_parabolas",
    "two_punches",
    "wavy",
    "wedge",
]
