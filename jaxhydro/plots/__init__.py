"""Style of the figures, and figures of motions."""
