"""Laws for drag and damping coefficients, added to a model at their neutral values."""

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import Literal

import numpy as np

from calibration.residuals.run_seas import Seas
from calibration.residuals.run_segments import sea_state
from calibration.residuals.wave_options import Options
from jaxhydro.dynamics.model import Model
from jaxhydro.dynamics.statics import natural_modes
from jaxhydro.loads.sea_state_law import exponent_label, with_exponents
from jaxhydro.platform.coefficients_schema import HighPass, KeuleganCarpenter
from jaxhydro.platform.drag_laws import DragLaw, drag_law_labels, plain_drag, surface_number, with_drag_laws
from jaxhydro.waves.sea_state import SeaState

Over = Literal["significant_height", "peak_period"]
Drag = Literal["keulegan_carpenter", "high_pass"]
Law = Literal["constant", "significant_height", "peak_period", "both", "keulegan_carpenter", "high_pass"]

EXPONENT_DEVIATION = 1.0  # standard deviation of the prior of an exponent about 0
DEFAULT_WINDOW = 60.0  # s, of a Keulegan-Carpenter number, where no motion has a natural period


def reference_sea_state(made: Seas, options: Options) -> SeaState:
    """Geometric mean of the sea states of the fitted tests, to two digits."""
    states = [sea_state(run, r, options.low, options.cutoff) for run, _ in made for r in run.records if r.use == "fit"]
    return SeaState(*(float(f"{math.exp(value):.2g}") for value in np.log(states).mean(axis=0)))


def with_sea_state_laws(model: Model, labels: Sequence[str], over: Sequence[Over], reference: SeaState) -> Model:
    """Add powers of the sea state, of exponent 0, to coefficients of a model.

    A coefficient that has such a power already keeps it.

    Args:
        model: The model.
        labels: Labels of the coefficients.
        over: Variables of the sea state.
        reference: Sea state that the powers refer to.
    """
    added = [(label, kind) for label in labels for kind in over if exponent_label(label, kind) not in model.values]
    return replace(model, loads=with_exponents(model.loads, dict.fromkeys(added, 0.0), reference))


def with_drag_law(model: Model, labels: Sequence[str], kind: Drag, state: SeaState, cutoff: float) -> tuple[Model, list[str]]:
    """Replace plain drag of a model by a law at its neutral value.

    "keulegan_carpenter" adds an exponent, 0. Its reference is the number of the waves' own motion at the surface in the sea
    `state`, to two digits. Its window is the longest natural period. "high_pass" adds the share of the coefficient that motion
    slower than the cutoff feels, 1.

    Args:
        model: The model.
        labels: Labels of the coefficients; those that are not of plain drag are left as they are.
        kind: Name of the law.
        state: Sea state of the reference.
        cutoff: Frequency that divides slow from fast motion (Hz).

    Returns:
        The model, and the labels of the added parameters, which are to be fitted.
    """
    plain = [label for label in plain_drag(model) if label in labels]
    laws: dict[str, DragLaw] = {}
    if kind == "keulegan_carpenter":
        periods = natural_modes(model).period
        finite = [float(f"{period:.2g}") for period in np.asarray(periods) if np.isfinite(period)]
        for label in plain:
            number = float(f"{surface_number(model.hull, label, state.significant_height):.2g}")
            laws[label] = KeuleganCarpenter(
                law=kind, exponent=0.0, reference=number, window=max(finite, default=DEFAULT_WINDOW)
            )
        return with_drag_laws(model, laws), [drag_law_labels(model, "exponent")[label] for label in plain]
    laws = {label: HighPass(law=kind, cutoff=cutoff, low_share=1.0) for label in plain}
    return with_drag_laws(model, laws), [drag_law_labels(model, "low_share")[label] for label in plain]


LAWS: dict[str, tuple[tuple[Over, ...], Drag | None]] = {
    "constant": ((), None),
    "significant_height": (("significant_height",), None),
    "peak_period": (("peak_period",), None),
    "both": (("significant_height", "peak_period"), None),
    "keulegan_carpenter": ((), "keulegan_carpenter"),
    "high_pass": ((), "high_pass"),
}
