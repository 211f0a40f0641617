"""
A bulk stress moves the stick zone
==================================

The body under the pad is stretched while the pad is pushed: as in a fretting fatigue test. The
tension σ tilts the corrective problem, the stick zone moves towards one side, and with more of it
slip has two directions.
"""

import matplotlib.pyplot as plt
import numpy as np

import sie

pad = sie.solve(
    sie.Scene(
        profile=sie.Parabola(radius=100.0),
        body=sie.Elastic(young=115e3, poisson=0.32),
        normal_load=300.0,
        friction=0.6,
        tangential_load=60.0,
    )
)
x = np.linspace(*pad.edges, 1001)
limit = 0.6 * pad.pressure(x)
fig, ax = plt.subplots(layout="constrained")
ax.fill_between(x, -limit, limit, color="0.92", label="|q| ≤ f p")
for k, sigma in enumerate((0.0, 60.0, 120.0, 240.0)):
    loaded = pad.with_(bulk_stress=sigma)
    ax.plot(x, loaded.shear(x), color=f"C{k}", label=f"σ = {sigma:.0f} MPa")
    for zone in loaded.stick:
        ax.plot(zone, [-(1.1 + 0.06 * k) * limit.max()] * 2, color=f"C{k}", linewidth=3)
ax.set(xlabel="x, mm", ylabel="shear traction, MPa (bars: stick zones)")
fig.legend(loc="outside right upper")
plt.show()
