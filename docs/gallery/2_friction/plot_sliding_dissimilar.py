"""
Sliding of dissimilar bodies
============================

Between bodies of different elasticity (β ≠ 0) friction acts on the pressure: it leans to one side,
and the exponents of the edges differ.
"""

import matplotlib.pyplot as plt
import numpy as np

import sie

x = np.linspace(-1.4, 1.4, 1401)
fig, ax = plt.subplots(layout="constrained")
for beta in (0.0, 0.25, 0.5):
    sliding = sie.solve(
        sie.Scene(
            profile=sie.RoundedFlat(half_flat=0.5, radius=1.0),
            modulus=1.0,
            dundurs=beta,
            poisson=0.3,
            friction=0.6,
            normal_load=0.4,
            tangential_load=0.6 * 0.4,
        )
    )
    ax.plot(x, sliding.pressure(x), label=f"β = {beta}")
ax.set(xlabel="x/R", ylabel="p/E*")
ax.legend()
plt.show()
