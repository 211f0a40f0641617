"""Two equal punches on one body, pressed together: one name for a family of modules.

two_punches.flats        sharp-edged, on a < |x| < b
two_punches.parabolas    radius R each, centres apart
"""

from analytic import two_flats as flats
from analytic import two_parabolas as parabolas

__all__ = ["flats", "parabolas"]
