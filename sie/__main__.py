"""`python -m sie` is the command `sie`."""

from .cli import main

if __name__ == "__main__":
    raise SystemExit(main())
