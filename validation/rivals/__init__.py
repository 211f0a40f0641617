"""Other methods in short form, the contacts on which they race, and the races."""
