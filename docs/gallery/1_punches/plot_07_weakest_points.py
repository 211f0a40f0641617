"""
The path of the weakest point
=============================

Fig. 7 of Ciavarella, Hills & Monno (1998): where the body yields first while the coefficient of
friction grows, a cross for each step of 0.025. From a place below it moves up and outwards, and
jumps to the surface.
"""

import matplotlib.pyplot as plt
import numpy as np

from sie import charts

frictions = (0.025 * np.arange(21)).tolist()
found = charts.elastic_limits((0.0, 0.3, 0.6, 0.9), frictions)
fig, ax = plt.subplots(layout="constrained")
for ratio, x, y in zip(found.ratios, found.x, found.y):
    ax.plot(x, y, "x-", linewidth=0.6, label=f"{ratio:g}")
ax.set(xlabel="x/b", ylabel="y/b")
ax.invert_yaxis()
ax.legend(title="a/b")
plt.show()
