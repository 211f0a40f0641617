"""
Where fretting wear ends
========================

A cylinder is pushed to and fro by less than f P. What slips wears, step by step after Archard; the
stick zone keeps its shape. The steps lead to a state that `sie.wear_limit` gives at once, without
time and without a law: the stick zone alone carries the load, and beside it the bodies just touch.
"""

import matplotlib.pyplot as plt
import numpy as np

import sie

cylinder = sie.Parabola(100.0)  # mm
steel = sie.Elastic(young=210e3, poisson=0.3)
loads = {"body": steel, "normal_load": 200.0, "friction": 0.5}
limit = sie.wear_limit(sie.Scene(profile=cylinder, tangential_load=60.0, **loads))
(lo, hi), (left, right) = limit.stick, limit.worn
print(f"stick zone {lo:.3f} to {hi:.3f} mm, worn from {left:.3f} to {right:.3f} mm")
print(f"volume {limit.volume:.3g} mm³ per mm")

# %%
# The same by steps
# -----------------
#
# Outside the stick zone the height that is lost in a step is proportional to the pressure.

x = np.linspace(-1.0, 1.0, 161)
height = cylinder.height(x)
slips = (x < limit.stick[0]) | (x > limit.stick[1])
worn_per_step = 1.3e-7  # mm per MPa

fig, (above, below) = plt.subplots(2, 1, sharex=True, layout="constrained")
for step in range(91):
    contact = sie.solve(sie.Scene(profile=sie.Sampled(x, height), body=steel, normal_load=200.0))
    pressure = contact.pressure(x)
    if step in (0, 12, 90):
        above.plot(x, pressure, label=f"after {step} steps")
        below.plot(x, 1e3 * (height - cylinder.height(x)))
    height = height + worn_per_step * pressure * slips
fine = np.linspace(-0.8, 0.8, 2001)
above.plot(fine, limit.pressure(fine), "k--", label="limit")
below.plot(fine, 1e3 * limit.depth(fine), "k--")
above.set(xlabel="x, mm", ylabel="pressure, MPa", ylim=(0.0, 500.0))
above.legend(fontsize=8)
below.set(xlabel="x, mm", ylabel="depth of wear, µm", xlim=(-0.8, 0.8))
plt.show()
