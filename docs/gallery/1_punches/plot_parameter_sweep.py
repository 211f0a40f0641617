"""
A sweep over friction and tilt
==============================

The largest tension beside a rounded punch under one Q: it rises with friction, and with a tilt that
presses the trailing edge down. A sweep solves a grid of scenes and returns labelled arrays; chunks
of neighbours share what does not change.
"""

import matplotlib.pyplot as plt
import numpy as np

import sie

scene = sie.Scene(
    profile=sie.RoundedFlat(half_flat=1.0, radius=50.0),
    body=sie.Elastic(young=210e3, poisson=0.3),
    normal_load=400.0,
    friction=0.4,
    tangential_load=60.0,
)
over = {"friction": np.linspace(0.2, 0.8, 7), "tilt": np.linspace(-1e-3, 1e-3, 11)}
table = sie.sweep(scene, over=over, want=["peak_tension"])
tension = np.asarray(table["peak_tension"])
fig, ax = plt.subplots(layout="constrained")
drawn = ax.contourf(1e3 * over["tilt"], over["friction"], tension, 14)
fig.colorbar(drawn, label="largest tension, MPa")
ax.set(xlabel="tilt, mrad", ylabel="coefficient of friction")
plt.show()
