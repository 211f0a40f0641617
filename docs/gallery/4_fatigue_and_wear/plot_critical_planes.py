"""
From a fretting mission to damage by pyLife
===========================================

A mission with a large and a small loop of Q runs again and again. Its stresses go to
`pyLife <https://pylife.readthedocs.io>`_, which counts their loops and adds up the damage by a
Wöhler curve; beside it stand the parameters that `sie.Cycle` finds on critical planes. Without
pyLife the script draws these alone.
"""

import matplotlib.pyplot as plt
import numpy as np

import sie

try:
    import pandas as pd
    import pylife.strength.fatigue
    import pylife.stress.equistress
    from pylife.stress import rainflow
except ImportError:
    pylife = None

# %%
# The mission
# -----------
#
# It is followed twice: what the second run does is repeated from there on.

scene = sie.Scene(
    profile=sie.RoundedFlat(half_flat=1.0, radius=50.0),
    body=sie.Elastic(young=115e3, poisson=0.32),
    normal_load=500.0,
    friction=0.6,
)
mission = [(500.0, 250.0), (500.0, -250.0), (500.0, 100.0), (500.0, -50.0), (500.0, 250.0)]
history = sie.follow(scene, sie.Path([(500.0, 0.0), *mission, *mission[1:]]))
cycle = sie.Cycle(history[-len(mission) :])

# %%
# The parameters on critical planes
# ---------------------------------
#
# Without positions a method finds the place where the parameter is largest: the edge of contact.

left = history[0].edges[0]
x = left + 0.25 * np.linspace(-1.0, 1.0, 81) * history[0].half_width
swt, findley = cycle.swt(x), cycle.findley(x, k=0.3)
worst = cycle.findley(k=0.3)
fig, ax = plt.subplots(layout="constrained")
ax.plot(x, findley.value / worst.value, label=f"Findley, {worst.value:.0f} MPa at most")
ax.plot(x, swt.value / swt.value.max(), label=f"Smith-Watson-Topper, {swt.value.max():.2f} MPa")
ax.axvline(worst.x, color="0.7", zorder=0)

# %%
# The damage by pyLife
# --------------------
#
# `history` gives the tensors of every state, which pyLife takes in Voigt's order, x, y, z, xy, xz,
# yz. Here it counts the loops of the largest principal stress.


def damage(tensors, curve):
    components = zip(
        ("S11", "S22", "S33", "S12", "S13", "S23"), (0, 1, 2, 0, 0, 1), (0, 1, 2, 1, 2, 2)
    )
    voigt = pd.DataFrame({name: tensors[:, i, j] for name, i, j in components})
    signal = voigt.equistress.max_principal().to_numpy()
    loops = rainflow.LoopValueRecorder()
    rainflow.FourPointDetector(recorder=loops).process(np.tile(signal[:-1], 3))
    return curve.fatigue.damage(loops.collective.load_collective).sum()


if pylife:
    curve = pd.Series({"k_1": 5.0, "ND": 1e6, "SD": 100.0})
    tensors = cycle.history(x, 0.0)
    damages = np.array([damage(tensors[:, k], curve) for k in range(len(x))])
    ax.plot(x, damages / damages.max(), "--", label="damage by pyLife")
ax.set(xlabel="x on the surface near the edge of contact, mm", ylabel="part of the largest value")
ax.legend(fontsize=8)
plt.show()
