"""
Wear, by solving again and again
================================

The package has no law of wear; a user brings one. Archard's: the height that is lost in a cycle is
proportional to pressure times sliding distance. A cylinder that slides to and fro wears flat, and
the pressure with it becomes even. Where the wear has just arrived the surface has a convex corner:
there the pressure peaks, and wears it away.
"""

import matplotlib.pyplot as plt
import numpy as np

import sie

x = np.linspace(-3.0, 3.0, 241)
height = x**2 / (2 * 100.0)  # mm
steel = sie.Elastic(young=210e3, poisson=0.3)
# Wear per step in mm per MPa: wear coefficient times distance times cycles. Waves as short as two
# points grow from step to step beyond 4 dx/(π E*).
worn_per_step = 2e-7

fig, (above, below) = plt.subplots(2, 1, sharex=True, layout="constrained")
for step in range(61):
    contact = sie.solve(sie.Scene(profile=sie.Sampled(x, height), body=steel, normal_load=200.0))
    pressure = contact.pressure(x)
    if step in (0, 5, 20, 60):
        above.plot(x, pressure, label=f"after {step} steps")
        below.plot(x, 1e3 * height)
    height = height + worn_per_step * pressure
above.set(xlabel="x, mm", ylabel="pressure, MPa")
above.legend(fontsize=8)
below.set(xlabel="x, mm", ylabel="gap before, µm", xlim=(-2.0, 2.0), ylim=(0.0, 8.0))
plt.show()
