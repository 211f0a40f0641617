"""Programs with a known error: the checks must catch each of them."""
