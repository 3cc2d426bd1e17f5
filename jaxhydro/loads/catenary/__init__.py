"""Catenary mooring lines: their equations, the solution of these, and the load."""
