"""The README's picture: slow surge of a sea that was not fitted, from a diagnosis of FOCAL campaign 2.

    python -m benchmarks.readme_figure FOLDER

FOLDER holds what `jaxhydro diagnose` wrote, such as the results of `python -m benchmarks.validate --only lacking`.
"""

import argparse
from pathlib import Path

import numpy as np
import xarray as xr
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from benchmarks.evidence.common import within
from jaxhydro.analysis.motion_bands import bands
from jaxhydro.plots.style import BEFORE, MEASURED, SIMULATED, save, style

PICTURE = Path(__file__).resolve().parents[1] / "docs" / "figures" / "closed-loop.png"
TEST, PEAK_PERIOD = "sea-8m", 12.5  # s
SHOWN = 1000.0  # s
LOOKS = {
    "measured": (MEASURED, 2.2, "measured"),
    "before": (BEFORE, 1.3, "strip model fitted to two lower seas"),
    "simulated": (SIMULATED, 1.2, "the same with what jaxhydro found missing"),
}


def draw(folder: Path, path: Path) -> None:
    """Draw measured and simulated slow surge.

    Args:
        folder: Results of the diagnosis.
        path: The picture.
    """
    low, high = bands("surge", PEAK_PERIOD)["low_frequency"]
    with xr.open_dataset(folder / "simulated.nc") as motion, style():
        motions = motion.sel(test=TEST, channel="surge")
        time = motions.time.values - motions.time.values[0]
        figure = Figure(figsize=(6.0, 2.7), layout="constrained")
        FigureCanvasAgg(figure)
        ax = figure.subplots()
        for kind, (colour, width, label) in LOOKS.items():
            values = within(motions[kind].values, low, high, float(np.diff(time[:2])[0]))
            shown = time[: len(values)] < SHOWN
            ax.plot(time[: len(values)][shown], values[shown], color=colour, lw=width, label=label)
        ax.set_xlabel("Time (s)")
        ax.set_ylabel("Slow surge (m)")
        ax.margins(x=0.0)
        title = "A 1:70 floating-wind platform in a sea that was not fitted"
        legend = figure.legend(loc="outside upper left", title=title, alignment="left", ncols=1)
        legend.get_title().set_fontweight("bold")
        save(figure, path)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path)
    draw(parser.parse_args().folder, PICTURE)
