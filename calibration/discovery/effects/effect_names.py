"""Names of effects in words."""

EFFECT_NAMES = {
    "coulomb_friction": "Coulomb friction",
    "mass_properties": "wrong mass properties",
    "mooring_nonlinearity": "a nonlinear mooring",
    "static_offset": "a static offset (a force, or a sensor's zero)",
    "umbilical": "an umbilical",
    "current": "a current",
    "hidden_oscillator": "a hidden oscillator",
    "sensor_reference": "a wrong tracked point",
    "sea_state_dependent_drag": "a drag coefficient of its own for slow motion",
    "sensor_lag": "a sensor lag",
    "sensor_sign": "a wrong sign",
    "wave_gauge_position": "a wrong wave gauge position",
    "wave_reflection": "reflected waves",
    "wave_excitation": "another wave excitation",
    "slender_body_forces": "second-order forces on members",
    "diffraction_correction": "first-order wave forces of potential flow",
    "potential_flow": "potential-flow tables of the platform file",
}


def effect_in_words(effect: str, motion: str | None = None) -> str:
    """Name of an effect in words.

    `coulomb_friction (surge)`, or effect and motion apart, becomes "Coulomb friction in surge".
    """
    name, _, inside = effect.removesuffix(")").partition(" (")
    words = EFFECT_NAMES.get(name, name.replace("_", " "))
    motion = motion or inside
    return f"{words} in {motion}" if motion else words


def capitalised(words: str) -> str:
    """Words with a capital first letter."""
    return f"{words[:1].upper()}{words[1:]}"
