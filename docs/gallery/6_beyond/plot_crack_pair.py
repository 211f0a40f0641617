"""
Two cracks and the ligament between them
========================================

Not a contact: the same solver takes any Cauchy equation. Two cracks of length 1 under unit
pressure; when the ligament is thin, the stress intensity at the inner tips grows without bound.
"""

import matplotlib.pyplot as plt
import numpy as np

import sie

ligaments = np.geomspace(1e-8, 10.0, 40)
inner, outer = [], []
for gap in ligaments.tolist():
    cracks = sie.CauchyEquation(
        ((-1.0 - gap / 2, -gap / 2), (gap / 2, 1.0 + gap / 2)), g=1.0, total=(0.0, 0.0)
    )
    _, (near, far) = cracks.solve().intensities
    inner.append(abs(near))
    outer.append(abs(far))
single = abs(sie.CauchyEquation((0.0, 1.0), g=1.0, total=0.0).solve().intensities[0][1])
fig, ax = plt.subplots(layout="constrained")
ax.loglog(ligaments, np.array(inner) / single, label="inner tips")
ax.loglog(ligaments, np.array(outer) / single, label="outer tips")
ax.set(xlabel="ligament over crack length", ylabel="K over that of one crack")
ax.legend()
plt.show()
