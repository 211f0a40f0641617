"""
The pressure under a flat punch with rounded edges
==================================================

Fig. 2 of Ciavarella, Hills & Monno (1998). The curves belong to a/b = 0, 0.1, …, 0.9: half the
flat part over the half-width of the contact. From a parabola (Hertz) to an almost sharp flat punch
the peak moves outwards and rises slowly.
"""

import matplotlib.pyplot as plt
import numpy as np

import sie

x = np.linspace(-1.0, 1.0, 801)
fig, ax = plt.subplots(layout="constrained")
for ratio, colour in zip(np.arange(10) / 10, plt.cm.viridis(np.linspace(0.0, 0.9, 10))):
    profile = sie.RoundedFlat(ratio, radius=1.0) if ratio else sie.Parabola(radius=1.0)
    punch = sie.solve(sie.Scene(profile=profile, modulus=1.0, poisson=0.3, half_width=1.0))
    ax.plot(x, punch.pressure(x) / punch.normal_load, color=colour, label=f"{ratio:.1f}")
ax.set(xlabel="x/b", ylabel="b p/P", ylim=(0.0, 1.45))
ax.legend(title="a/b", ncols=2)
plt.show()
