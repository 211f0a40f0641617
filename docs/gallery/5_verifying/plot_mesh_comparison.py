"""
A finite-element result beside the truth
========================================

The nodal pressures of a mesh, here a stand-in with an element size of R/40 whose peak is smeared,
against the exact ones. `sie compare scene.toml mesh.csv` does it for the files that codes write.
"""

import matplotlib.pyplot as plt
import numpy as np

import sie

exact = sie.solve(
    sie.Scene(
        profile=sie.RoundedFlat(half_flat=1.0, radius=4.0),
        body=sie.Elastic(young=210e3, poisson=0.3),
        normal_load=2000.0,
    )
)
size = 0.1
nodes = np.arange(-1.6, 1.6 + size / 2, size)
# A node's pressure is the mean over its two elements, weighted by its shape function.
s, w = np.polynomial.legendre.leggauss(30)
near = nodes[:, None] + size * s
mesh = (exact.pressure(near) * (1 - np.abs(s)) * w).sum(1)
x = np.linspace(-1.6, 1.6, 1601)
fig, (above, below) = plt.subplots(2, 1, sharex=True, layout="constrained")
above.plot(x, exact.pressure(x), label="exact")
above.plot(nodes, mesh, "o", markersize=3, label="mesh")
above.set(xlabel="x, mm", ylabel="pressure, MPa")
above.legend()
below.stem(nodes, mesh - exact.pressure(nodes), basefmt="k-", markerfmt=".")
below.set(xlabel="x, mm", ylabel="mesh minus exact, MPa")
plt.show()
