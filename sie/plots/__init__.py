"""Pictures of an answer. They need Matplotlib, which nothing else here does."""

try:
    import matplotlib as matplotlib
except ImportError:
    raise ImportError('a picture needs Matplotlib: pip install "plane-contact[plot]"') from None
