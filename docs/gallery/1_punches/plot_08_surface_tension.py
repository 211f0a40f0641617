"""
The tension that starts cracks
==============================

Fig. 8 of Ciavarella, Hills & Monno (1998): the largest tension of the surface, behind the trailing
edge, against the half-width of the stick zone.
"""

import matplotlib.pyplot as plt
import numpy as np

from sie import charts

c = 1.0 - np.linspace(1.0, 0.0, 101) ** 2  # closer together where the curves are steep
fig, ax = plt.subplots(layout="constrained")
for ratio in (0.0, 0.2, 0.4, 0.6, 0.8):
    ax.plot(c, charts.surface_tension(ratio, c), label=f"{ratio:g}")
ax.set(xlabel="c/b", ylabel="π b σ_xx/(f P)")
ax.legend(title="a/b")
plt.show()
