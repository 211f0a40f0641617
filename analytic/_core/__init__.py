"""What the closed forms share: number systems, parameters, cuts, and special functions."""
