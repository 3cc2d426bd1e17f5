"""The model of a platform: its motion at an instant, statics, simulation, and what sensors record."""
