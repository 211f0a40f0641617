"""Periodic contacts: one name for a family of modules.

periodic.wavy            Westergaard's wavy surface
periodic.flat_row        a row of flat punches
periodic.parabola_row    a row of parabolas
periodic.cracks          a row of collinear cracks (`cracks.row`)
"""

from analytic import cracks, flat_row, parabola_row, wavy

__all__ = ["cracks", "flat_row", "parabola_row", "wavy"]
