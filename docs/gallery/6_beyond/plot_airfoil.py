"""
A thin airfoil
==============

The vortex sheet of a thin airfoil solves the equation of a contact with one sharp edge: infinite at
the leading edge, zero at the trailing one (Kutta). Points: the pressure of a flat plate in closed
form.
"""

import matplotlib.pyplot as plt
import numpy as np

import sie

alpha = np.radians(4.0)
x = np.linspace(0.005, 1.0, 400)
fig, ax = plt.subplots(layout="constrained")
for camber in (0.0, 0.02, 0.04):
    foil = sie.CauchyEquation(
        (0.0, 1.0),
        g=lambda x, c=camber: alpha - 4 * c * (1 - 2 * x),
        b=-0.5,
        ends=("singular", "bounded"),
    ).solve()
    ax.plot(x, 2 * foil(x), label=f"camber {camber:.0%}, lift {2 * foil.resultant:.3f}")
ax.plot(x[::20], 4 * alpha * np.sqrt((1 - x) / x)[::20], "k.", label="flat plate, closed form")
ax.set(xlabel="x / chord", ylabel="pressure difference / dynamic pressure", ylim=(0.0, 2.0))
ax.legend()
plt.show()
