"""Joint selection of missing effects on a linearised model."""
