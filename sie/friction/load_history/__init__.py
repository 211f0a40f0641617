"""The steps of a load history: the contact that changes, and the steps that are marched."""
