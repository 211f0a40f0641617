"""
Where a sliding punch stresses the body
=======================================

Fig. 4 of Ciavarella, Hills & Monno (1998): contours of b√J₂/P without friction and in full sliding.
From a/b = 0.3 to 0.8 the peak (the cross) rises; friction raises it further and brings it to the
surface.
"""

import matplotlib.pyplot as plt
import numpy as np

import sie

X, Y = np.meshgrid(np.linspace(-2.0, 2.0, 161), np.linspace(0.0, 2.0, 81))
fig, axes = plt.subplots(3, 2, sharex=True, sharey=True, layout="compressed", figsize=(7.0, 5.2))
for ratio, row in zip((0.3, 0.55, 0.8), axes):
    pressed = sie.solve(
        sie.Scene(profile=sie.RoundedFlat(ratio, 1.0), modulus=1.0, poisson=0.3, half_width=1.0)
    )
    for friction, ax in zip((0.0, 0.3), row):
        sliding = pressed.with_(friction=friction, tangential_load=friction * pressed.normal_load)
        parameter = np.sqrt(sliding.stress(X, Y).j2) / pressed.normal_load
        drawn = ax.contour(X, Y, parameter, levels=np.linspace(0.05, 0.4, 15), linewidths=0.8)
        weakest = sliding.elastic_limit()
        ax.plot(*zip(*weakest.places), "kx")
        ax.set_title(f"a/b = {ratio}, f = {friction}", fontsize=9)
        ax.set(xlabel="x/b", ylabel="y/b", aspect="equal")
axes[0, 0].invert_yaxis()
fig.colorbar(drawn, ax=axes, label="b √J₂ / P")
plt.show()
