"""
Partial slip and the fretting loop
==================================

A punch is pressed with P and moved to and fro by Q. The shear keeps what earlier loads locked in;
the force over the shift is a loop, whose area is the energy that friction dissipates.
"""

import matplotlib.pyplot as plt
import numpy as np

import sie

scene = sie.Scene(
    profile=sie.RoundedFlat(half_flat=1.0, radius=50.0),
    body=sie.Elastic(young=210e3, poisson=0.3),
    normal_load=500.0,
    friction=0.5,
)
turns = np.concatenate(
    [np.linspace(0, 180, 10), np.linspace(180, -180, 37)[1:], np.linspace(-180, 180, 37)[1:]]
)
path = sie.follow(scene, sie.Path([(500.0, Q) for Q in turns.tolist()]))
fig, (left, right) = plt.subplots(1, 2, layout="constrained", figsize=(8.0, 3.6))
x = np.linspace(*path[0].edges, 801)
for k in (9, 18, 27, 36):
    left.plot(x, path[k].shear(x), label=f"Q = {turns[k]:.0f} N/mm")
left.set(xlabel="x, mm", ylabel="shear traction, MPa")
left.legend(fontsize=8)
right.plot([1e3 * point.shift for point in path], turns)
right.locator_params(axis="x", nbins=4)
right.set(xlabel="shift of the punch by slip, µm", ylabel="Q, N/mm")
lost = path[-1].energy_lost - path[9].energy_lost
right.set_title(f"{1e3 * lost:.2f} µJ per mm and cycle", fontsize=9)
plt.show()
