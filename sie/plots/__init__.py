"""Pictures of an answer. Only these modules need Matplotlib."""

try:
    import matplotlib as matplotlib
except ImportError:
    raise ImportError('a picture needs Matplotlib: pip install "plane-contact[plot]"') from None

from .comparison_plot import overlay as overlay
from .contact_plot import picture as picture
from .stress_plot import contours as contours
