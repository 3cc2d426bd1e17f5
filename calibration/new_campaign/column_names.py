"""Channels that column names stand for, such as surge for PtfmSurge or "Surge (m)"."""

from __future__ import annotations

import re

from calibration.campaign.manifest_sections import DOFS, WAVE

_GREEK = {"φ": "phi", "ϕ": "phi", "θ": "theta", "ψ": "psi", "η": "eta", "ζ": "zeta"}
_AXES = dict(zip(("x", "y", "z", "phi", "theta", "psi"), DOFS))
_ROTATIONS = dict(zip(("rx", "ry", "rz"), DOFS[3:]))
_TIMES = {"time", "t", "timestamp", "seconds", "zeit", "clock"}
_WAVES = {"elev": 3, "elevation": 3, "eta": 3, "zeta": 3, "wave": 2, "waves": 2, "wg": 1, "wp": 1, "probe": 1, "gauge": 1}
_UNIT_WORDS = {"s", "ms", "sec", "m", "mm", "cm", "ft", "deg", "degs", "rad", "mrad"}
_FILLERS = {
    *("ptfm", "platform", "hull", "body", "model", "motion", "motions", "pos", "position", "disp", "displacement", "angle"),
    *("cog", "cg", "meas", "measured", "exp", "test", "dof", "do", "f", "deg", "in", "of", "the", "rot", "trans", "offset"),
}
_OTHER_QUANTITIES = {
    *("vel", "velocity", "acc", "accel", "acceleration", "force", "moment", "rate", "speed", "dot", "torque", "tension"),
    *("bld", "blade", "nac", "nacelle", "rotor", "gen", "twr", "tower", "imu", "gyro", "cmd", "ref"),
    *("sim", "simulated", "period", "dir", "direction", "freq", "frequency", "std", "error", "noise"),
}
_RATE_UNIT = re.compile(r"[(\[{<][^()\[\]{}<>]*(/|\^|²|s2|N)[^()\[\]{}<>]*[)\]}>]")
_BRACKETS = re.compile(r"[(\[{<][^()\[\]{}<>]*[)\]}>]\s*$")
_WORDS = re.compile(r"[A-Z]+(?=[A-Z][a-z])|[A-Z]?[a-z]+|[A-Z]+|[^\W\d_]+")

EXACT, CONTAINED = 2, 1  # how well a name fits a channel


def channel_of(column: str) -> tuple[str, int] | None:
    """Find the channel that a column's name stands for, and how well the name fits it.

    Args:
        column: The column's name, perhaps with a unit.

    Returns:
        The channel (time, a motion or wave) and a rank that is higher for a better fit. None for another quantity.
    """
    words = _words(column)
    if not words or _RATE_UNIT.search(column) or set(words) & _OTHER_QUANTITIES:
        return None
    telling = [word for word in words if word not in _FILLERS]
    motions = [word for word in telling if word in DOFS]
    if len(motions) == 1:
        return motions[0], EXACT if len(telling) == 1 else CONTAINED
    if motions:
        return None
    if rank := max((_WAVES.get(word, 0) for word in telling), default=0):
        return WAVE, rank
    if len(telling) == 1:
        (word,) = telling
        if word in _AXES or word in _ROTATIONS:
            return _rotation(words, word), EXACT
        if word in _TIMES:
            return "time", EXACT
    return ("time", CONTAINED) if "time" in telling else None


def motion_in(name: str) -> str | None:
    """Find the one motion that the name of a file has as a word, such as pitch in pitch-2.csv."""
    motions = [word for word in _words(name) if word in DOFS]
    return motions[0] if len(set(motions)) == 1 else None


def is_greek(column: str) -> bool:
    """Tell whether a column is named by the letter of an angle: phi, theta, psi."""
    return bool({"phi", "theta", "psi"} & set(_words(column)))


def _rotation(words: list[str], word: str) -> str:
    if word in _ROTATIONS:
        return _ROTATIONS[word]
    motion = _AXES[word]
    return DOFS[DOFS.index(motion) + 3] if word in "xyz" and "rot" in words else motion


def _words(column: str) -> list[str]:
    """The words of a name in lower case, without its unit."""
    text = "".join(f" {_GREEK[letter]} " if letter in _GREEK else letter for letter in _BRACKETS.sub("", column))
    words = [word.lower() for word in _WORDS.findall(text)]
    while len(words) > 1 and words[-1] in _UNIT_WORDS:
        words.pop()
    return words
