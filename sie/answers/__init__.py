"""The stages of a solution, and what is answered from them."""
