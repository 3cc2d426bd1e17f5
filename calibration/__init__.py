"""Fits a jaxhydro model to measurements."""
