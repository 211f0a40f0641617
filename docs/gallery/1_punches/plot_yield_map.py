"""
A chart of yield for a designer
===============================

The load at which a punch of steel yields first grows with the flat part and with the radius of the
edges. Elasticity has no length of its own: the contact of E* = R = b = 1 says at which width every
punch of its a/b yields, so that one table of a/b serves all radii.
"""

import matplotlib.pyplot as plt
import numpy as np

import sie

steel = sie.Elastic(young=210e3, poisson=0.3)
modulus = steel.young / (2 * (1 - steel.poisson**2))  # E* of steel on steel, MPa
shear_yield = 350.0 / np.sqrt(3.0)  # MPa

ratios = np.linspace(0.02, 0.995, 60)
load, stress = np.empty((2, len(ratios)))
for k, ratio in enumerate(ratios.tolist()):
    unit = sie.solve(
        sie.Scene(profile=sie.RoundedFlat(ratio, 1.0), modulus=1.0, poisson=0.3, half_width=1.0)
    )
    load[k] = unit.normal_load
    stress[k] = np.sqrt(unit.elastic_limit().j2)  # the largest sqrt(J2) in units of E* b/R

fig, ax = plt.subplots(layout="constrained")
for radius in (5.0, 10.0, 20.0, 50.0, 100.0):
    width = shear_yield * radius / (modulus * stress)  # half-width at first yield, mm
    ax.plot(ratios * width, modulus * width**2 / radius * load, label=f"{radius:g} mm")
ax.set(xlabel="half of the flat part, mm", ylabel="load at first yield, N/mm")
ax.set(xlim=(0.0, 3.0), ylim=(0.0, 2500.0))
fig.legend(title="radius of the edges", loc="outside right upper")
plt.show()
