"""The stress in the body: yield, surface tension, load cycles."""
