"""
The load at first yield
=======================

Fig. 5 of Ciavarella, Hills & Monno (1998): the load P/(bk) at which a body of the shear yield
stress k yields, and how deep. Up to a/b = 0.54 a rounded punch is stronger than a Hertzian contact.
"""

import matplotlib.pyplot as plt
import numpy as np

from sie import charts

ratios = np.linspace(0.0, 0.98, 50).tolist()
found = charts.elastic_limits(ratios, [0.0])
fig, ax = plt.subplots(layout="constrained")
ax.plot(ratios, found.limit[:, 0], label="P/(bk)")
ax.axhline(found.limit[0, 0], color="0.6", linestyle="--", label="Hertz")
ax.set(xlabel="a/b", ylabel="elastic limit P/(bk)", ylim=(0.0, None))
ax.legend(loc="lower left")
depth = ax.twinx()
depth.plot(ratios, found.y[:, 0], color="C1")
depth.set(xlabel="a/b", ylabel="depth of first yield y/b", ylim=(0.0, None))
depth.yaxis.label.set_color("C1")
plt.show()
