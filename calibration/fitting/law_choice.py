"""Choice of a law for coefficients that depend on the sea state, by held-out tests."""

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, get_args

import numpy as np

from calibration.campaign.load_campaign import Campaign
from calibration.fitting.law_parameters import LAWS, Law
from calibration.fitting.progress import Progress
from calibration.fitting.sea_fit import calibrate_in_waves
from calibration.identifiability.findings import Identifiability
from calibration.residuals.run_seas import Seas, seas_of
from calibration.residuals.run_segments import sea_state
from calibration.residuals.wave_options import Options, options_of
from calibration.result import Calibration, error_of_energies
from jaxhydro.errors import InputError, Problem
from jaxhydro.interrupts import stopping
from jaxhydro.loads.drag.keulegan_carpenter_law import log_ratio
from jaxhydro.loads.sea_state_law import coefficients, exponent_label, reference_of
from jaxhydro.platform.coefficients_schema import KeuleganCarpenter
from jaxhydro.platform.drag_laws import drag_law_labels, drag_laws_of, law_labels, surface_number
from jaxhydro.waves.sea_state import SeaState

HELD_OUT_TOLERANCE = 0.02  # of the held-out error, by which a later law has to be better to be chosen


@dataclass(frozen=True, eq=False)
class LawFit:
    """Calibration with one law, and its errors.

    Attributes:
        name: Name of the law.
        calibration: The calibration.
        fitted: Root mean square of ln(simulated / measured energy) in the bands of the fitted tests.
        held_out: The same for tests that the law was not fitted to.
    """

    name: str
    calibration: Calibration
    fitted: float
    held_out: float

    def added(self) -> dict[str, float]:
        """Values of the parameters that the law adds, by label."""
        laws = law_labels(self.calibration.model)
        return {label: estimate.value for label, estimate in self.calibration.parameters.items() if label in laws}

    def coefficient(self, label: str, state: SeaState) -> tuple[float, float]:
        """A coefficient in a sea state, and the standard deviation of its logarithm.

        A power of the Keulegan-Carpenter number is taken for the waves' own motion at the surface, 2 a = Hs. Where drag
        treats slow motion apart, the coefficient is that of fast motion.
        """
        model, identifiability = self.calibration.model, self.calibration.identifiability
        value = float(coefficients(model.in_sea(state).loads)[label])
        assert identifiability is not None
        reference = reference_of(model.loads)
        logs = (
            {}
            if reference is None
            else {exponent_label(label, over): math.log(now / then) for over, now, then in zip(state._fields, state, reference)}
        )
        law = drag_laws_of(model).get(label)
        if isinstance(law, KeuleganCarpenter):
            ratio = float(log_ratio(surface_number(model.hull, label, state.significant_height) ** 2, law.reference))
            value *= math.exp(law.exponent * ratio)
            logs[drag_law_labels(model, "exponent")[label]] = ratio
        return value, _deviation(identifiability, label, logs)


def _deviation(identifiability: Identifiability, label: str, logs: Mapping[str, float]) -> float:
    """Standard deviation of ln c0 + sum of exponents times logarithms."""
    parameters = identifiability.parameters
    row = np.zeros(len(parameters.labels))
    for i, name in enumerate(parameters.labels):
        if name == label:
            row[i] = parameters.slope[i] / parameters.value[i]
        elif name in logs:
            row[i] = parameters.slope[i] * logs[name]
    return float(np.sqrt(max(row @ identifiability.covariance @ row, 0.0)))


@dataclass(frozen=True, eq=False)
class SeaStateFit:
    """Calibration to one test in irregular waves.

    Attributes:
        id: Name of the test.
        use: Use of the test: `fit`, `holdout` or `ignore`.
        state: Measured sea state.
        calibration: Calibration to this test alone.
    """

    id: str
    use: str
    state: SeaState
    calibration: Calibration


@dataclass(frozen=True, eq=False)
class SeaLaws:
    """Laws over the sea state, compared on tests that they were not fitted to.

    Attributes:
        laws: Calibrations by law, in the order asked for.
        seas: Calibrations to single sea states.
        judged_by: Names of the tests on which the laws are compared.
        left_out: Whether these are fitted tests left out in turn, since no test is held out.
        finished: False where the user stopped the comparison; then there are only the finished calibrations.
    """

    laws: tuple[LawFit, ...]
    seas: tuple[SeaStateFit, ...]
    judged_by: tuple[str, ...]
    left_out: bool
    finished: bool = True

    @property
    def chosen(self) -> LawFit:
        """The law with the least held-out error; an earlier law that is as good to 2 % is preferred."""
        least = min(law.held_out for law in self.laws)
        return next(law for law in self.laws if law.held_out <= (1 + HELD_OUT_TOLERANCE) * least)

    def labels(self) -> list[str]:
        """Labels of coefficients that depend on the sea state or the motion in any of the laws."""
        return list(dict.fromkeys(law_labels(law.calibration.model)[label] for law in self.laws for label in law.added()))


def choose_law(
    campaign: Campaign,
    *,
    laws: Sequence[Law] = get_args(Law),
    free: Sequence[str] | None = None,
    start: dict[str, float] | None = None,
    options: Options | None = None,
    progress: Callable[[Progress], None] | None = None,
) -> SeaLaws:
    """Choose a law over the sea state for drag and damping coefficients, by tests not fitted.

    The laws are constants, powers of the sea state, and drag as a power of the Keulegan-Carpenter number or apart for slow
    and fast motion. Every law is fitted to the tests in irregular waves marked `fit`. The laws are compared on the tests
    marked `holdout`; where there is none, on the fitted ones left out in turn. Energies in bands are the objective. Other
    laws start where the constants ended; their values are also the centre of the priors sea by sea.

    Args:
        campaign: The campaign.
        laws: Names of the laws.
        free: As in `calibrate_in_waves`.
        start: As in `calibrate_in_waves`.
        options: As in `calibrate_in_waves`.
        progress: Function that is called with the progress after every iteration.

    Returns:
        A calibration by law, one by sea state, and the chosen law.

    Raises:
        InputError: If there are too few tests to compare laws.
        Interrupted: If the user stops it before a law is fitted.
    """
    options = options_of(campaign) if options is None else options
    source = str(campaign.folder / "campaign.yaml")
    fitted, held = ([r.id for r in campaign.used(use) if r.kind == "irregular"] for use in ("fit", "holdout"))
    if len(fitted) < (2 if held else 3):
        expected = "two tests in irregular waves marked `fit` and one `holdout`, or three marked `fit`"
        raise InputError(source, [Problem("tests", expected, f"{len(fitted)} and {len(held)}")])
    made = seas_of(campaign, campaign.model.environment, options)
    count = len(laws) * (1 if held else 1 + len(fitted)) + len(fitted) + len(held)
    done = 0

    def fit_law(name: str, uses: Mapping[str, str], begin: dict[str, float] | None, law: str = "constant") -> Calibration:
        nonlocal done
        over, drag = LAWS[law]

        def report(now: Progress) -> None:
            if progress is not None:
                stage = f"{done + 1} of {count}, {name}: {now.stage}"
                progress(replace(now, stage=stage, fraction=(done + now.fraction) / count))

        used, seas = with_test_uses(campaign, made, uses)
        calibration = calibrate_in_waves(
            used, free=free, start=begin, options=options, over=over, drag=drag, made=seas, progress=report
        )
        done += 1
        return calibration

    law_fits: list[LawFit] = []
    seas: list[SeaStateFit] = []
    finished = False
    try:
        for name in laws:
            begin = {k: p.value for k, p in law_fits[0].calibration.parameters.items()} if law_fits else start
            whole = fit_law(name, {}, begin, name)
            if held:
                judged = [energy_error(whole, held)]
            else:
                judged = [energy_error(fit_law(f"{name} without {id}", {id: "holdout"}, begin, name), [id]) for id in fitted]
            law_fits.append(LawFit(name, whole, energy_error(whole, fitted), float(np.sqrt(np.mean(np.square(judged))))))
        added = law_fits[0].added()
        values = {k: p.value for k, p in law_fits[0].calibration.parameters.items() if k not in added}
        for id in [*fitted, *held]:
            alone = {test: "fit" if test == id else "ignore" for test in [*fitted, *held]}
            record, run = next((r, run) for run, _ in made for r in run.records if r.id == id)
            state = sea_state(run, record, options.low, options.cutoff)
            seas.append(SeaStateFit(id, record.use, state, fit_law(f"{id} alone", alone, values)))
        finished = True
    except KeyboardInterrupt:
        stopping()
        if not law_fits:
            raise
    return SeaLaws(tuple(law_fits), tuple(seas), tuple(held or fitted), not held, finished)


def energy_error(calibration: Calibration, tests: Sequence[str]) -> float:
    """Root mean square of ln(simulated / measured energy) over the bands of tests."""
    bands = [band for test in calibration.tests if test.id in tests for row in test.bands.values() for band in row.values()]
    return error_of_energies(band.after for band in bands)


def with_test_uses(campaign: Campaign, made: Seas, uses: Mapping[str, str]) -> tuple[Campaign, Seas]:
    """The campaign and its runs with other uses of some tests.

    Runs in which no test is left are left out.

    Args:
        campaign: The campaign.
        made: Runs of the campaign and their seas.
        uses: New use of a test, by its id.
    """

    def changed(records: Sequence[Any]) -> tuple[Any, ...]:
        return tuple(replace(record, use=uses.get(record.id, record.use)) for record in records)

    runs = ((replace(run, records=tuple(r for r in changed(run.records) if r.use != "ignore")), sea) for run, sea in made)
    return replace(campaign, records=changed(campaign.records)), tuple((run, sea) for run, sea in runs if run.records)
