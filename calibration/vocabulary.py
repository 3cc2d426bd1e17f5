"""Words shared by tables, pages and figures."""

from collections.abc import Sequence

Rows = tuple[tuple[str, ...], Sequence[tuple[str, ...]]]
USE = {"fit": "fitted", "holdout": "held out", "ignore": "ignored"}
KINDS = {"decay": "free decay", "irregular": "irregular waves", "regular": "regular waves"}
UNDETERMINED = "not determined"  # behind a value in brackets
BANDS = {"low_frequency": "low frequency", "wave_frequency": "wave frequency"}
LAW_NAMES = {
    "constant": "constant",
    "significant_height": "power of Hs",
    "peak_period": "power of Tp",
    "both": "powers of Hs and Tp",
    "keulegan_carpenter": "power of KC",
    "high_pass": "slow motion apart",
}
