"""Paths of loads, and what a state on them is compared with."""

import sie

E, F, P = 2.0, 0.5, 0.375
PUNCH = sie.Scene(profile=sie.RoundedFlat(0.7, 1.0), modulus=E, normal_load=P, friction=F)
HERTZ = sie.Scene(profile=sie.Parabola(1.0), modulus=E, normal_load=P, friction=F)
LOPSIDED = sie.Scene(
    profile=sie.Polynomial((0.0, 0.05, 1.0, 0.4, 0.6)),
    modulus=E,
    normal_load=P,
    friction=F,
    tilt=0.02,
)
FP = F * P


def at_constant_load(scene: sie.Scene, *fractions: float) -> sie.History:
    return sie.follow(scene, sie.Path([(P, k * FP) for k in fractions]))
