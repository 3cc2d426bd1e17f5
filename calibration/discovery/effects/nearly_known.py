"""Nearly known quantities: standard deviations of mass properties and moorings."""

from jaxhydro.dynamics.model import Model

MASS, INERTIA = 0.005, 0.01  # of the declared mass and moments of inertia
CENTRE_UP, CENTRE_ALONG = 0.0037, 0.00074  # of `displaced_length`: 0.1 and 0.02 m for a platform of 20 000 t
STIFFNESS, PRETENSION = 0.02, 0.02  # of the declared mooring


def displaced_length(model: Model) -> float:
    """Length of a platform (m): cube root of the volume that its mass displaces."""
    return (float(model.body.mass) / float(model.environment.density)) ** (1 / 3)
