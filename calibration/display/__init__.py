"""How campaigns and results are shown: texts, HTML tables, data frames, axes, and draws for ArviZ.

Methods of `Campaign`, `Calibration`, `Diagnosis`, `Bootstrap` and `Samples` call these functions, and import them only then.
"""
