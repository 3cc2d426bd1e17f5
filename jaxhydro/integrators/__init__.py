"""Time integration at fixed steps, differentiable forward and in reverse."""
