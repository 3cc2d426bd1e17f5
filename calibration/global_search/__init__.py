"""Global search for a starting point: multi-start least squares."""
