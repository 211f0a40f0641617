"""
A profile for an even pressure
==============================

`sie.profile_for_pressure` turns equation (1) around: Lundberg's roller carries an even pressure, at
the price of a slope that is infinite at its ends. A pressure that falls to zero within the last
tenth of the contact needs none.
"""

import matplotlib.pyplot as plt
import numpy as np

import sie

x = np.linspace(-0.999, 0.999, 400)
wanted = {
    "Lundberg's roller, even": lambda x: 0.0 * x + 1.0,
    "nearly even": lambda x: np.sqrt(1.0 - x**20),
}
fig, (upper, lower) = plt.subplots(2, sharex=True, layout="constrained")
for name, p in wanted.items():
    pad = sie.profile_for_pressure(p, half_width=1.0, modulus=1.0)
    theta = np.pi * (np.arange(400) + 0.5) / 400
    load = float(np.pi / 400 * (p(np.cos(theta)) * np.sin(theta)).sum())
    solution = sie.solve(sie.Scene(profile=pad, modulus=1.0, normal_load=load))
    upper.plot(x, pad.height(x), label=name)
    for share in (1.0, 0.5):
        lighter = solution.with_(normal_load=share * load)
        lower.plot(x, lighter.pressure(x), label=f"{name}, {share:g} P")
upper.set(xlabel="x/b", ylabel="height h E*/(b p₀)")
upper.legend()
lower.set(xlabel="x/b", ylabel="pressure p/p₀")
lower.legend()
plt.show()
