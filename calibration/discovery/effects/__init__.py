"""Catalogue of candidate effects, and starting points for their fits."""
