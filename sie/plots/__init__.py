"""Pictures of an answer. Only these modules need Matplotlib."""

try:
    import matplotlib as matplotlib
except ImportError:
    raise ImportError('a picture needs Matplotlib: pip install "plane-contact[plot]"') from None
