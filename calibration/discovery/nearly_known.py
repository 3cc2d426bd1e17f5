"""What nobody declares as unknown and no laboratory knows exactly: by how much it may be off, one standard deviation."""

MASS, INERTIA = 0.005, 0.01  # of the declared
CENTRE_UP, CENTRE_ALONG = 0.1, 0.02  # m
STIFFNESS, PRETENSION = 0.02, 0.02  # of a declared mooring
