"""
A wavy surface, from first touch to full contact
================================================

Westergaard's problem: a sine wave pressed flat. The share of the surface in contact grows like the
root of the load and reaches one with a vertical tangent; the line is the closed form, the points
are the general solver for periodic profiles.
"""

import matplotlib.pyplot as plt
import numpy as np

import sie
from analytic import wavy

amplitude, wavelength = 0.01, 1.0
slope = 2 * np.pi * amplitude / wavelength
wave = sie.FromFunction(
    lambda x: slope * np.sin(2 * np.pi * x / wavelength), breaks=(), domain=(-0.5, 0.5)
)
flattens = np.pi * amplitude / wavelength  # mean pressure of full contact over E*
fig, (left, right) = plt.subplots(1, 2, layout="constrained", figsize=(9.0, 3.6))
x = np.linspace(-1.0, 1.0, 1001)
for share in (0.02, 0.2, 0.5, 0.8, 0.95, 1.0, 1.2):
    contact = sie.solve(
        sie.Scene(
            profile=sie.Periodic(wave, wavelength),
            modulus=1.0,
            poisson=0.3,
            normal_load=share * flattens * wavelength,
        )
    )
    left.plot(x, contact.pressure(x) / flattens, label=f"{share:g}")
    right.plot(share, contact.contact_length / wavelength, "ko", markersize=4)
left.set(xlabel="x / wavelength", ylabel="p / p̄ of full contact")
fig.legend(title="p̄ / p̄ of full contact", loc="outside left center")
shares = np.linspace(0.0, 1.0, 201)[1:-1]
half = wavy.half_width(
    mean_pressure=shares * flattens, amplitude=amplitude, wavelength=wavelength, modulus=1.0
)
right.plot([0.0, *shares, 1.0, 1.2], [0.0, *2 * half / wavelength, 1.0, 1.0])
right.set(xlabel="mean pressure / that of full contact", ylabel="share in contact")
plt.show()
