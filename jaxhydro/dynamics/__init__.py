"""Model, its motion at an instant, statics, simulation, and readings of sensors."""
