"""
Friction and the elastic limit
==============================

Fig. 6 of Ciavarella, Hills & Monno (1998): the elastic limit in full sliding. Each curve has a kink
where the weakest point jumps from below to the surface.
"""

import matplotlib.pyplot as plt
import numpy as np

from sie import charts

ratios, frictions = (0.0, 0.2, 0.4, 0.6, 0.8, 0.9), np.linspace(0.0, 0.5, 16).tolist()
found = charts.elastic_limits(ratios, frictions)
fig, ax = plt.subplots(layout="constrained")
for ratio, limit in zip(ratios, found.limit):
    ax.plot(frictions, limit, "k--" if ratio == 0.0 else "-", label=f"{ratio:g}")
ax.set(xlabel="coefficient of friction f", ylabel="P/(bk)", ylim=(0.0, None))
ax.legend(title="a/b")
plt.show()
