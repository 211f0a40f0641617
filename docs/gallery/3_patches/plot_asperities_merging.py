"""
Asperities that merge
=====================

Asperities of different heights on one holder. While the load grows patches appear, widen and merge;
the pressure of a valley that has just closed starts from zero.
"""

import matplotlib.pyplot as plt
import numpy as np

import sie

ridge = sie.FromFunction(lambda x: x / 4.0 + 0.25 * np.sin(5.0 * x), breaks=(), domain=(-4.0, 4.0))
x = np.linspace(-3.2, 3.2, 3201)
fig, axes = plt.subplots(2, 1, sharex=True, layout="constrained")
loads = np.geomspace(0.02, 2.0, 24)
answers = [
    sie.solve(sie.Scene(profile=ridge, modulus=1.0, poisson=0.3, normal_load=P))
    for P in loads.tolist()
]
for k in (4, 12, 18, 23):
    axes[0].plot(x, answers[k].pressure(x), label=f"P/(E* L) = {loads[k]:.2f}")
axes[0].set(xlabel="x/L", ylabel="pressure p/E*")
fig.legend(loc="outside right upper")
for P, answer in zip(loads, answers):
    for patch in answer.patches:
        axes[1].plot(patch, [P, P], color="C0", linewidth=1.5)
axes[1].set(xlabel="x/L", ylabel="load P/(E* L)", yscale="log")
plt.show()
