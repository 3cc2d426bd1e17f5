"""Campaigns: manifest, records, runs in waves, data quality."""
