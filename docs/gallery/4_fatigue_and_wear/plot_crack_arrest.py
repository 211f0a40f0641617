"""
Does the crack grow or stop?
============================

A crack normal to the surface begins at the trailing edge of a fretted contact, where the tension is
largest, and leaves the contact's stress behind as it grows. Where the range of K_I falls below the
threshold it stops; a bulk stress carries it through.
"""

import math

import matplotlib.pyplot as plt
import numpy as np

import sie

scene = sie.Scene(
    profile=sie.RoundedFlat(half_flat=1.0, radius=50.0),
    body=sie.Elastic(young=115e3, poisson=0.32),
    normal_load=500.0,
    friction=0.6,
)
limits = {"threshold": 80.0, "fatigue_limit": 400.0}  # MPa √mm and MPa
depth = np.geomspace(0.003, 3.0, 120)  # mm

fig, ax = plt.subplots(layout="constrained")
for bulk in (0.0, 40.0, 80.0):
    cycle = sie.steady_cycle(scene, (500.0, 200.0, bulk), (500.0, -200.0, -bulk)).cycle
    K = cycle.stress_intensity(at=cycle.states[0].pressure.interval[0], depth=depth)
    (line,) = ax.loglog(depth, K.range, label=f"bulk stress ±{bulk:g} MPa")
    stop = K.arrest(**limits)
    if math.isfinite(stop):
        ax.plot(stop, float(K.threshold(depth=stop, **limits)), "o", color=line.get_color())
ax.loglog(depth, K.threshold(**limits), "k--", label="threshold (El Haddad)")
ax.set(xlabel="depth of the crack, mm", ylabel="range of K_I, MPa √mm", ylim=(10.0, 400.0))
ax.legend()
plt.show()
