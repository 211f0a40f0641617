"""
How much of a contact of dissimilar bodies sticks
=================================================

Bodies of different elasticity slip outwards beside a stick zone while they are pressed together.
The ratio c/b of the stick zone to the contact depends on Dundurs' β and on the coefficient of
friction f alone: under every symmetric convex profile and every load it is that of a flat punch
(Spence 1975). It is drawn here over β and f. A point marks a punch of steel on titanium with
f = 0.3.
"""

import matplotlib.pyplot as plt
import numpy as np
from scipy.special import logit

import sie

# %%
# One flat punch for each pair of constants
# -----------------------------------------
#
# The half-width and the load of the punch are 1, so that the end of the stick zone is c/b.


def stick_ratio(beta, friction):
    scene = sie.Scene(
        profile=sie.Flat(1.0), modulus=1.0, dundurs=beta, friction=friction, normal_load=1.0
    )
    return sie.solve(scene).stick[0][1]


# Along lines of β/f, between which c/b changes little
frictions = np.linspace(0.05, 1.0, 12)[:, None]
betas = frictions * np.geomspace(0.25, np.minimum(5.0, 0.5 / frictions[:, 0]), 12).T
frictions = np.broadcast_to(frictions, betas.shape)
ratios = np.vectorize(stick_ratio)(betas, frictions)

# %%
# The chart
# ---------
#
# Next to β = 0 the bodies stick nearly everywhere. Where β exceeds f the stick zone is a small part
# of the contact.

punch = sie.Scene(
    profile=sie.RoundedFlat(1.0, 50.0),
    body=sie.Elastic(115e3, 0.32),
    indenter=sie.Elastic(210e3, 0.30),
    normal_load=600.0,
    friction=0.3,
)
fig, ax = plt.subplots(layout="constrained")
shares = [0.01, 0.1, 0.3, 0.5, 0.7, 0.8, 0.9, 0.95, 0.98, 0.99]
levels = logit(shares)  # which is smoother than c/b: the lines are too
lines = ax.contour(betas, frictions, logit(ratios), levels=levels, cmap="viridis_r")
ax.clabel(lines, fmt=dict(zip(levels, map(str, shares))), fontsize=8)
point = abs(punch.beta), punch.friction
ax.plot(*point, "ko")
ax.annotate("steel on titanium", point, (0.03, 0.6), arrowprops={"arrowstyle": "-"})
ax.set(xlabel="Dundurs' β", ylabel="coefficient of friction f", title="c/b", xlim=(0.0, 0.5))
plt.show()
