"""Fits of parameters to decays, to tests in waves, and to both."""
