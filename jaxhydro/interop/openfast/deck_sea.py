"""The sea of a deck: options of `jaxhydro simulate` that ask for the same.

References:
    OpenFAST v5.0.0 (2895884), SeaState input files; cut-offs in rad/s become Hz.
"""

import math
from collections.abc import Iterator

from jaxhydro.interop.conversion import ConvertedItem, Treatment
from jaxhydro.interop.openfast.keyed_file import KeyedFile

STRETCHING = {0: "none", 1: "vertical", 2: "extrapolation", 3: "wheeler"}
STILL, REGULAR, IRREGULAR = "0", "1", "2"
OTHER_SEAS = {
    "3": "White noise has no counterpart.",
    "4": "The spectrum of a user's routine has no counterpart.",
    "5": "Give the record of the elevation: `--wave FILE`.",
    "6": "Kinematics from files have no counterpart.",
    "7": "Components from a file: see `jaxhydro.waves.components` for Python.",
}


def sea_command(file: KeyedFile) -> str:
    """Options of `jaxhydro simulate` for the deck's waves; "" where there are none of that kind."""
    mode = file.word("WaveMod", STILL)
    heading = file.number("WaveDir", 0.0)
    turned = f" --heading {heading:g}" if heading else ""
    if mode.upper().startswith(REGULAR):
        return f"--wave-height {file.number('WaveHs'):g} --wave-period {file.number('WaveTp'):g}{turned}"
    if mode != IRREGULAR:
        return ""
    options = f"--hs {file.number('WaveHs'):g} --tp {file.number('WaveTp'):g}"
    if file.word("WavePkShp", "default").lower() != "default":
        options += f" --gamma {file.number('WavePkShp'):g}"
    low, high = (file.number(key, 0.0) / (2 * math.pi) for key in ("WvLowCOff", "WvHiCOff"))
    options += f" --low {low:.6g}" if low > 0.0 else ""
    options += f" --cutoff {high:.6g}" if high > 0.0 else ""
    if file.flag("WaveNDAmp", False):
        options += " --amplitudes rayleigh"
    second = file.flag("WvDiffQTF", False) or file.flag("WvSumQTF", False)
    options += "" if second else " --order 1"
    stretching = STRETCHING.get(file.whole("WaveStMod", 0), "vertical")
    return options + ("" if stretching == "vertical" else f" --stretching {stretching}") + turned


def sea_items(file: KeyedFile) -> Iterator[ConvertedItem]:
    """What became of the sea of a deck: the platform file holds none."""

    def item(keys: str, treatment: Treatment, meaning: str) -> ConvertedItem:
        return ConvertedItem(f"{file.name}: {keys}", treatment, meaning)

    mode = file.word("WaveMod", STILL)
    if options := sea_command(file):
        keys = "WaveMod, WaveHs, WaveTp, WavePkShp, WvLowCOff, WvHiCOff, WvDiffQTF, WvSumQTF, WaveStMod, WaveDir"
        text = f"The platform file holds no sea. The same sea state: `jaxhydro simulate platform.yaml {options}`."
        yield item(keys, Treatment.LEFT_OUT, text)
        text = "Phases are drawn anew (`--seed`): a seed of OpenFAST gives other waves here. Carry the elevation over instead."
        yield item("WaveSeed(1), WaveSeed(2)", Treatment.LEFT_OUT, text)
    elif mode == STILL:
        yield item("WaveMod", Treatment.LEFT_OUT, "Still water: `jaxhydro simulate platform.yaml --release heave=1`.")
    else:
        yield item(f"WaveMod {mode}", Treatment.LEFT_OUT, OTHER_SEAS.get(mode, "Not known, so not taken."))
    if file.whole("WaveDirMod", 0):
        yield item("WaveDirMod", Treatment.LEFT_OUT, "Waves come from one direction here.")
    if file.whole("ConstWaveMod", 0):
        yield item("ConstWaveMod", Treatment.LEFT_OUT, "Constrained waves have no counterpart.")
    if file.has("MCFD") and file.number("MCFD"):
        yield item("MCFD", Treatment.APPROXIMATED, "Every member with MCF diffracts with its own diameter.")
