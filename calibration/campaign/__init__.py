"""Measurement campaigns: manifest, records, runs in waves, data quality."""
