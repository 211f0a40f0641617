"""Mathematics that does not depend on mechanics."""
