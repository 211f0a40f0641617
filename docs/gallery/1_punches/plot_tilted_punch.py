"""
A tilted punch
==============

A flat punch with rounded edges carries an eccentric load. With the moment the pressure moves to one
edge; beyond a certain moment the flat part lifts off.
"""

import matplotlib.pyplot as plt
import numpy as np

import sie

punch = sie.RoundedFlat(half_flat=1.0, radius=20.0)
steel = sie.Elastic(young=210e3, poisson=0.3)
level = sie.solve(sie.Scene(profile=punch, body=steel, normal_load=300.0, moment=0.0))
x = np.linspace(-1.5, 1.7, 1601)
fig, (above, below) = plt.subplots(2, 1, sharex=True, layout="constrained")
for moment in (0.0, 60.0, 120.0, 180.0, 240.0):
    tilted = level.with_(moment=moment)
    above.plot(x, tilted.pressure(x), label=f"{moment / 300.0:.1f}")
    below.plot(x, 1e3 * tilted.gap(x))
above.set(ylabel="pressure, MPa", xlabel="x, mm")
above.legend(title="M/P, mm", ncols=2, fontsize=8, loc="upper center")
below.set(xlabel="x, mm", ylabel="gap, µm", ylim=(0.0, 3.0))
plt.show()
