"""Frequency bands in which motions are judged: low frequencies, and those of the waves."""

from jaxhydro.environment import DOFS

BANDS = {  # Hz, low and high
    "surge": (0.005, 0.025),
    "heave": (0.02, 0.055),
    "pitch": (0.02, 0.055),
    "wave": (0.06, 0.15),
    "wave, long": (0.05, 0.15),
}
"""Low-frequency bands of surge, heave and pitch, and the wave-frequency bands of a moderate and of a high sea: the paper's."""

LONG_PEAK_PERIOD = 0.7 / 0.06
"""Peak period (s) from which on a sea has energy below 0.06 Hz: JONSWAP has next to none below 0.7 of its peak."""


def bands(dof: str, peak_period: float) -> dict[str, tuple[float, float]]:
    """Low-frequency and wave-frequency band of a motion in a sea.

    From a peak period of 11.7 s on, the wave band begins at 0.05 Hz instead of 0.06 Hz. Sway has the bands of surge, and
    roll those of pitch.

    Args:
        dof: Name of a degree of freedom other than yaw.
        peak_period: Peak period of the sea (s).

    Returns:
        Limits (Hz) of `low_frequency` and `wave_frequency`.

    Raises:
        ValueError: For yaw, an unknown name, or a period that is not above 0.
    """
    same = {"sway": "surge", "roll": "pitch"}.get(dof, dof)
    if same not in DOFS or same not in BANDS:
        raise ValueError(f"bands are known for surge, sway, heave, roll and pitch, found {dof!r}")
    if not peak_period > 0:
        raise ValueError(f"peak_period is above 0 s, found {peak_period}")
    return {"low_frequency": BANDS[same], "wave_frequency": BANDS["wave, long" if peak_period >= LONG_PEAK_PERIOD else "wave"]}
