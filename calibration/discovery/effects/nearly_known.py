"""What nobody declares as unknown and no laboratory knows exactly: by how much it may be off, one standard deviation."""

from jaxhydro.dynamics.model import Model

MASS, INERTIA = 0.005, 0.01  # of the declared
CENTRE_UP, CENTRE_ALONG = 0.0037, 0.00074  # of `displaced_length`: 0.1 and 0.02 m of a platform of 20 000 t
STIFFNESS, PRETENSION = 0.02, 0.02  # of a declared mooring


def displaced_length(model: Model) -> float:
    """A length (m) that goes with a platform: the cube root of the volume that its mass displaces."""
    return (float(model.body.mass) / float(model.environment.density)) ** (1 / 3)
