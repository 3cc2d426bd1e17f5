"""Readers of other programs' files into plain arrays."""
