"""Damping of free decays: linear and quadratic (P-Q), and its sources in the model."""
