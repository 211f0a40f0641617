"""
Tension behind the trailing edge
================================

The surface stress of a pad that is pushed to the right. Tension peaks at the trailing edge, the
left one, where fretting cracks start; a bulk stress adds to it.
"""

import matplotlib.pyplot as plt
import numpy as np

import sie

pad = sie.solve(
    sie.Scene(
        profile=sie.RoundedFlat(half_flat=1.0, radius=40.0),
        body=sie.Elastic(young=115e3, poisson=0.32),
        normal_load=350.0,
        friction=0.6,
    )
)
x = np.linspace(-2.0, 2.0, 1601)
fig, ax = plt.subplots(layout="constrained")
for share in (0.0, 0.3, 0.6, 0.9):
    pushed = pad.with_(tangential_load=share * 0.6 * 350.0)
    (line,) = ax.plot(x, pushed.surface_stress(x).xx, label=f"Q/(f P) = {share:g}")
    peak = pushed.peak_tension()
    if peak.value > 0.0:
        ax.plot(peak.x, peak.value, "o", color=line.get_color())
ax.axhline(0.0, color="0.7", linewidth=0.8)
ax.set(xlabel="x, mm", ylabel="σ_xx at the surface, MPa")
ax.legend()
plt.show()
