"""
A worn pad from a profilometer
==============================

A measured trace, smoothed as much as its noise asks for, is a profile like any other. The pad was a
cylinder; wear has left a flat with waves on it.
"""

import matplotlib.pyplot as plt
import numpy as np

import sie

rng = np.random.default_rng(3)
x = np.linspace(-2.0, 2.0, 321)
worn = np.maximum(x**2 / 120.0, 4e-3 + 4e-4 * np.sin(11.0 * x))  # mm
measured = worn + 3e-5 * rng.standard_normal(len(x))
pad = sie.Sampled(x, measured, smoothing="gcv")

fine = np.linspace(-1.5, 1.5, 2001)
fig, (above, below) = plt.subplots(2, 1, sharex=True, layout="constrained")
for load in (5.0, 50.0, 250.0):
    contact = sie.solve(sie.Scene(profile=pad, body=sie.Elastic(115e3, 0.32), normal_load=load))
    above.plot(
        fine, contact.pressure(fine), label=f"{load:.0f} N/mm: {len(contact.patches)} patches"
    )
above.set(xlabel="x, mm", ylabel="pressure, MPa")
above.legend(fontsize=8)
below.plot(x, 1e3 * measured, ".", markersize=2, color="0.6")
below.plot(fine, 1e3 * pad.height(fine), color="k", linewidth=0.8)
below.set(xlabel="x, mm", ylabel="gap before, µm", xlim=(-1.5, 1.5), ylim=(3.0, 8.0))
plt.show()
