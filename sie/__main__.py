"""`python -m sie` is the command `sie`."""

from .cli import main

raise SystemExit(main())
