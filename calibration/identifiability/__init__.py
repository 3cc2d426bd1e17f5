"""Identifiability: information, covariance, weak directions, statements."""
