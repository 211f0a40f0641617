"""Periodic contacts: one name for a family of modules.

periodic.wavy        Westergaard's wavy surface
periodic.flat_row    a row of flat punches
periodic.cracks      a row of collinear cracks (`cracks.row`)
"""

from analytic import cracks, flat_row, wavy

__all__ = ["cracks", "flat_row", "wavy"]
