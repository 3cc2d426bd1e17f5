"""Uncertainty of a calibration: likelihood, profiles, bootstrap, NUTS, test design."""
