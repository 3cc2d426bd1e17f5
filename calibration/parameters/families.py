"""Families of parameters: inertia, damping, restoring, exponents."""

from collections.abc import Collection


def parameter_family(label: str, laws: Collection[str]) -> str:
    """Family of a parameter: "inertia", "damping", "restoring" or "exponent".

    An exponent says how a coefficient depends on the sea or the motion.

    Args:
        label: Label of the parameter.
        laws: Labels of the parameters that laws add to coefficients (`law_labels`).
    """
    if label in laws:
        return "exponent"
    head, _, name = label.rpartition(".")
    if head.startswith(("tuned_mass_dampers.", "liquid_column_dampers.")):
        return {"mass": "inertia", "area": "inertia", "period": "restoring"}.get(name, "damping")
    if head == "added_mass" or head.startswith("guided_masses.") or name.startswith("Ca"):
        return "inertia"
    return "damping" if head.endswith("damping") or name == "damping" or name.startswith("Cd") else "restoring"
