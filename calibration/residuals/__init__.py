"""Residuals of a model against measurements: decays, seas, blocks, offsets, periods."""
