"""
Steel on titanium: what dissimilarity does to a fretting cycle
==============================================================

A steel cylinder is pressed on titanium and moved to and fro by Q. While it was pressed the softer
titanium was drawn inwards, and friction held it: that shear stays locked in, and the stick zone of
the cycle lies off the middle. Dashed: the same cycle with β = 0, as if the two were one material.
"""

import matplotlib.pyplot as plt
import numpy as np

import sie

scene = sie.Scene(
    profile=sie.Parabola(radius=50.0),
    body=sie.Elastic(young=110e3, poisson=0.34),  # titanium
    indenter=sie.Elastic(young=210e3, poisson=0.30),  # steel
    normal_load=100.0,
    friction=0.3,
)
loads = [(100.0, 0.0), (100.0, 18.0), (100.0, -18.0), (100.0, 18.0)]
real = sie.follow(scene, sie.Path(loads))
alike = sie.follow(sie.solve(scene).with_(dundurs=0.0).scene, sie.Path(loads))

fig, axes = plt.subplots(1, 2, sharey=True, layout="constrained", figsize=(8.0, 3.6))
for ax, k, name in zip(axes, (1, 2), ("pushed to the right", "and back to the left")):
    x = np.linspace(*real[k].edges, 801)
    limit = scene.friction * real[k].pressure(x)
    ax.fill_between(x, -limit, limit, color="0.92", label="|q| ≤ f p")
    ax.plot(x, real[k].shear(x), label="steel on titanium")
    ax.plot(x, alike[k].shear(x), "C0--", label="β = 0")
    for lo, hi in real[k].stick:
        ax.plot([lo, hi], [0.0, 0.0], "C2", linewidth=4, label="sticks")
    ax.set(xlabel="x, mm", ylabel="shear traction q, MPa", title=name)
axes[0].legend(fontsize=8, loc="lower left")
lost = [1e3 * (path[3].energy_lost - path[1].energy_lost) for path in (real, alike)]
fig.suptitle(
    "energy of a cycle: {:.3f} µJ per mm; with β = 0: {:.3f} µJ per mm".format(*lost), fontsize=9
)
plt.show()
