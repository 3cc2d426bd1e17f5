"""Fits of parameters to residuals of all kinds."""
