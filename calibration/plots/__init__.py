"""Figures of calibrations, comparisons and diagnoses."""
