"""Other methods, written small, the contacts on which they race, and the races."""
