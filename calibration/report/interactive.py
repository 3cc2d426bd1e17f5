"""Interactive part of a page: series that can be zoomed, and the moving platform in three dimensions.

The page holds plotly.js once, compressed. Series are 16-bit integers between their smallest and largest value, which is finer
than a screen.
"""

import base64
import gzip
import json
from functools import cache
from itertools import product
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from markupsafe import Markup

from calibration.formatting import listed, number
from calibration.report.recorded_motion import RecordedMotion, RecordedTest, read_motion
from jaxhydro.units import unit_of

MAX_SAMPLES = 500_000  # of all series of a page: 1.3 MB
MISSING = -32768  # a sample that is no number
LEVELS = 65534
WITHOUT_PLOTLY = (
    "Series that can be zoomed and the moving platform need plotly, which is not installed here: pip install plotly."
)


class MotionView(NamedTuple):
    """Content of the interactive part.

    Attributes:
        data: JSON that its script reads; a part of a script element.
        plotly: plotly.js, compressed (gzip, base64).
        hull: Whether the platform is shown.
        tests: Names of the tests.
        notes: What was done to the series, in sentences.
    """

    data: Markup
    plotly: Markup
    hull: bool
    tests: list[str]
    notes: list[str]


def motion_view(folder: Path) -> MotionView | str | None:
    """Interactive part of the page of a result folder.

    Args:
        folder: The result folder.

    Returns:
        The part; a sentence where it cannot be made; None where the folder has no series.
    """
    motion = read_motion(folder)
    if motion is None:
        return None
    script = plotly_script()
    if script is None:
        return WITHOUT_PLOTLY
    every = sum(len(test.time) * len(rows) for test in motion.tests for rows in test.shown.values())
    thinning = max(1, -(-every // MAX_SAMPLES))
    content = {"tests": [_test(test, thinning) for test in motion.tests], "hull": _hull(motion)}
    text = json.dumps(content, ensure_ascii=True, allow_nan=False).replace("<", "\\u003c").replace(">", "\\u003e")
    names = [test.name for test in motion.tests]
    return MotionView(Markup(text), Markup(script), motion.hull is not None, names, list(_notes(motion, thinning)))


@cache
def plotly_script() -> str | None:
    """plotly.js, compressed and in base64; None where plotly is not installed."""
    try:
        from plotly.offline import get_plotlyjs
    except ImportError:
        return None
    return base64.b64encode(gzip.compress(get_plotlyjs().encode("utf-8"), 9, mtime=0)).decode("ascii")


def _notes(motion: RecordedMotion, thinning: int) -> list[str]:
    notes = []
    if thinning > 1:
        step = 2 * thinning * max(float(np.median(np.diff(test.time))) for test in motion.tests)
        notes.append(f"Series are thinned: of every {number(step, 3)} s the smallest and the largest sample are shown.")
    if motion.offsets:
        sizes = listed([f"{number(size, 2)} {unit_of(name)} in {name}" for name, size in motion.offsets.items()])
        notes.append(f"Sensor offsets that the fit found are taken off the measured series: up to {sizes}.")
    if motion.hull is None:
        notes.append("No hull is drawn: the model has no members, or an earlier version wrote these results.")
    return notes


def _test(test: RecordedTest, thinning: int) -> dict[str, Any]:
    panels = []
    for channel, rows in test.shown.items():
        traces = [{"name": source, **packed(thinned(values, thinning))} for source, values in rows.items()]
        panels.append({"name": channel, "unit": unit_of(channel), "traces": traces})
    step = float(test.time[-1] - test.time[0]) / max(len(test.time) - 1, 1) * thinning
    stretch = test.stretch()
    poses = {source: _floats(values) for source, values in stretch.poses.items()}
    frames = {"start": float(stretch.times[0]), "step": float(stretch.times[1] - stretch.times[0]), "poses": poses}
    return {"name": test.name, "start": float(test.time[0]), "step": step, "panels": panels, "frames": frames}


def thinned(values: np.ndarray, factor: int) -> np.ndarray:
    """Fewer samples of a series: the smallest and the largest of every `2 factor`, in their order.

    Args:
        values: Series, (n,).
        factor: How many times fewer samples.
    """
    if factor == 1:
        return values
    cells = -(-len(values) // (2 * factor))
    padded = np.pad(values, (0, 2 * factor * cells - len(values)), mode="edge").reshape(cells, -1)
    low, high = (np.where(np.isnan(padded), limit, padded) for limit in (np.inf, -np.inf))
    pairs = np.stack([low.min(axis=1), high.max(axis=1)], axis=1)
    later = low.argmin(axis=1) > high.argmax(axis=1)
    pairs[later] = pairs[later, ::-1]
    return np.where(np.isfinite(pairs), pairs, np.nan).reshape(-1)


def packed(values: np.ndarray) -> dict[str, Any]:
    """A series as 16-bit integers (base64) with their offset and scale."""
    low, high = float(np.nanmin(values)), float(np.nanmax(values))
    scale = (high - low) / LEVELS or 1.0
    whole = np.where(np.isnan(values), MISSING, np.round((np.nan_to_num(values, nan=low) - low) / scale) - LEVELS // 2)
    return {"offset": low + LEVELS // 2 * scale, "scale": scale, "data": _encoded(whole.astype("<i2"))}


def _floats(values: np.ndarray) -> str:
    return _encoded(np.round(values, 5).astype("<f4"))


def _encoded(values: np.ndarray) -> str:
    return base64.b64encode(values.tobytes()).decode("ascii")


def _hull(motion: RecordedMotion) -> dict[str, str] | None:
    """Points of the hull and its triangles: sides and both ends of every element."""
    if motion.hull is None:
        return None
    elements, ends, points, _ = motion.hull.shape
    triangles = []
    for element, k in product(range(elements), range(points)):
        low = element * ends * points
        high, after = low + points, (k + 1) % points
        triangles += [(low + k, low + after, high + after), (low + k, high + after, high + k)]
        if 0 < k < points - 1:
            triangles += [(low, low + after, low + k), (high, high + k, high + after)]
    return {"points": _floats(motion.hull.reshape(-1, 3)), "triangles": _encoded(np.array(triangles, dtype="<u2"))}
