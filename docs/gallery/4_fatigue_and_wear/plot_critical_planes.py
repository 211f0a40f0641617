"""
A fretting mission, and where it cracks
=======================================

A mission with a large and a small loop of Q runs again and again. The parameters that `sie.Cycle`
finds on critical planes, along the surface beside the left edge: both peak at the edge (the grey
line). `Cycle.history` gives the stress tensors for another criterion, or for a package that counts
loops.
"""

import matplotlib.pyplot as plt
import numpy as np

import sie

scene = sie.Scene(
    profile=sie.RoundedFlat(half_flat=1.0, radius=50.0),
    body=sie.Elastic(young=115e3, poisson=0.32),
    normal_load=500.0,
    friction=0.6,
)
mission = [(500.0, 250.0), (500.0, -250.0), (500.0, 100.0), (500.0, -50.0), (500.0, 250.0)]
# Followed twice: what the second run does is repeated from there on.
history = sie.follow(scene, sie.Path([(500.0, 0.0), *mission, *mission[1:]]))
cycle = sie.Cycle(history[-len(mission) :])

edge = history[0].edges[0]
t = np.linspace(-1.0, 1.0, 121)
x = edge + 0.25 * t**3 * history[0].half_width
worst = cycle.findley(k=0.3), cycle.swt()  # without positions: the largest value, and its place
fig, ax = plt.subplots(layout="constrained")
for name, unit, values, most in (
    ("Findley", "MPa", cycle.findley(x, k=0.3).value, worst[0].value),
    ("Smith-Watson-Topper", "MPa", cycle.swt(x).value, worst[1].value),
):
    ax.plot(x, values / most, label=f"{name}, at most {most:.3g} {unit}")
ax.axvline(edge, color="0.7", zorder=0)
ax.set(xlabel="x on the surface, mm", ylabel="part of the largest value")
fig.legend(loc="outside upper center", ncols=2)
plt.show()
