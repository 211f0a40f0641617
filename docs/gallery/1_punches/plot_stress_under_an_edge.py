"""
Stress a billionth below an edge
================================

Under the edge of a contact with a thin rim the stress changes over distances far below a mesh. The
depth here goes down to 1e-10 of the half-width; points are the closed form.
"""

import matplotlib.pyplot as plt
import numpy as np

import sie
from analytic import interior

rim, depth = 1e-4, np.geomspace(1e-10, 10.0, 200)
punch = sie.RoundedFlat(half_flat=1.0, radius=1.0)
contact = sie.solve(sie.Scene(profile=punch, modulus=1.0, poisson=0.3, half_width=1.0 + rim))
edge = contact.edges[1]
fig, ax = plt.subplots(layout="constrained")
stress = contact.stress(edge, depth)
exact = interior.rounded_flat(edge, depth, half_flat=1.0, rim=rim, radius=1.0, modulus=1.0)
peak = float(contact.pressure(1.0))
for name in ("xx", "yy", "xy"):
    (line,) = ax.semilogx(depth, getattr(stress, name) / peak, label=f"σ_{name}")
    ax.plot(depth[::9], getattr(exact, name)[::9] / peak, ".", color=line.get_color())
ax.set(xlabel="depth below the edge / a", ylabel="stress / p(a)")
ax.legend()
plt.show()
