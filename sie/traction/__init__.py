"""A traction on an interval: its values, its resultant and its Cauchy potential."""
