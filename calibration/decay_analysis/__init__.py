"""Damping of free decays: linear and quadratic (P-Q), and what members contribute."""
