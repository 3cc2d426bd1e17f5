"""How well a calibration is known: likelihood, profiles, bootstrap, draws, test design."""
