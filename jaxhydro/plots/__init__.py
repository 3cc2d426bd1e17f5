"""How figures look, and the figures of motions."""
