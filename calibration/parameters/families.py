"""Families of parameters: inertia, damping, restoring, exponents."""

from jaxhydro.loads.sea_state_law import is_exponent
from jaxhydro.platform.drag_laws import coefficient_label


def parameter_family(label: str) -> str:
    """What a parameter does to the platform: inertia, damping, restoring, or how one of them depends on sea or motion."""
    if is_exponent(label) or coefficient_label(label) is not None:
        return "exponent"
    head, _, name = label.rpartition(".")
    if head == "added_mass" or head.startswith("guided_masses.") or name.startswith("Ca"):
        return "inertia"
    return "damping" if head.endswith("damping") or name.startswith("Cd") else "restoring"
