"""
The textbook's collocation beside exact panels
==============================================

Gauss-Chebyshev collocation of three punches, all pressed until the contact is (-1, 1). It is
excellent for a smooth slope. At a kink it converges like a low power of n, while the panels of the
package, which are exact between kinks, have nothing to converge.
"""

import matplotlib.pyplot as plt
import numpy as np

import sie
from sie import teaching

profiles = {
    "smooth: h' = sinh x": sie.FromFunction(np.sinh, breaks=(), domain=(-2.0, 2.0)),
    "two kinks: rounded flat": sie.RoundedFlat(half_flat=0.6, radius=1.0),
    "a jump: wedge": sie.Wedge(slope=1.0),
}
nodes = 2 ** np.arange(1, 11)
fig, ax = plt.subplots(layout="constrained")
for (name, profile), colour in zip(profiles.items(), ("C0", "C1", "C2")):
    exact = sie.solve(sie.Scene(profile=profile, modulus=2.0, poisson=0.3, half_width=1.0))
    errors = []
    for n in nodes:
        t, p, _ = teaching.solve(profile.slope, n, index=-1)
        seen = np.abs(t) > 0.02  # the pressure of a wedge is infinite at 0
        errors.append(np.abs(p - exact.pressure(t))[seen].max() / exact.pressure(t)[seen].max())
    ax.loglog(nodes, errors, "o-", color=colour, label=name)
    ax.axhline(exact.check().error, color=colour, linestyle=":")
ax.set(xlabel="nodes n", ylabel="largest error of p over its peak", ylim=(1e-17, 2.0))
ax.legend(title="dotted: the certificate of the panels", loc="center right")
plt.show()
