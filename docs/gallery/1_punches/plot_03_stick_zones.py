"""
How much sticks under a tangential load
=======================================

Fig. 3 of Ciavarella, Hills & Monno (1998): the half-width c of the stick zone against Q/(fP). No
stick zone ends inside the flat part: c falls to a as the punch begins to slide, with a vertical
tangent.
"""

import matplotlib.pyplot as plt
import numpy as np

import sie

# Closer together where the curves are steep
shares = 1.0 - (1.0 - np.linspace(0.001, 0.999, 80)) ** 2
fig, ax = plt.subplots(layout="constrained")
for ratio in (0.0, 0.2, 0.4, 0.6, 0.8, 0.9):
    profile = sie.RoundedFlat(ratio, radius=1.0) if ratio else sie.Parabola(radius=1.0)
    pressed = sie.solve(
        sie.Scene(profile=profile, modulus=1.0, poisson=0.3, half_width=1.0, friction=0.5)
    )
    loads = 0.5 * pressed.normal_load * shares
    c = [pressed.with_(tangential_load=Q).stick[0][1] for Q in loads.tolist()]
    ax.plot([0.0, *shares, 1.0], [1.0, *c, ratio], label=f"{ratio:g}")
ax.set(xlabel="Q/(fP)", ylabel="c/b", ylim=(0.0, 1.0))
ax.legend(title="a/b")
plt.show()
