"""Slopes of all records along every candidate effect, at a fitted point."""

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from calibration.discovery.effect_fits import EffectFits
from calibration.discovery.effects.candidates import Candidate
from calibration.discovery.effects.phase_shift_start import phase_shift_factor, phase_shift_start
from calibration.discovery.fit_state import FitState
from calibration.discovery.linearisations import Linearisation
from calibration.discovery.record_simulations import KnownSlopes
from calibration.discovery.search import ListedVariant
from calibration.discovery.selection.candidate_passes import CandidateValues, first_passes, is_nearly_known, jobs_of, packed
from calibration.discovery.selection.linear_model import LinearModel
from calibration.discovery.selection.study_linear_model import linear_model
from calibration.discovery.selection.subsets import Variant

LABORATORY_EFFECTS = ("sensor_reference", "sensor_lag", "wave_gauge_position", "static_offset")
LABORATORY_LOG_ODDS, PHYSICS_LOG_ODDS = math.log(0.05), math.log(0.02)  # one effect is expected, among some forty


@dataclass(frozen=True)
class CandidateColumns:
    """A linear model of all candidate effects at a fitted point.

    Attributes:
        model: The linear model.
        base: Columns of coefficients and nuisances.
        variants: Candidates at values of their shapes.
        values: These values by variant.
        directions: Direction of the study of every column.
        series: Series of every pool.
        linearisation: Linearisation along the base directions and the effects in the model.
    """

    model: LinearModel
    base: tuple[int, ...]
    variants: tuple[Variant, ...]
    values: tuple[Mapping[str, float], ...]
    directions: tuple[int, ...]
    series: np.ndarray
    linearisation: Linearisation

    @property
    def laboratory(self) -> frozenset[int]:
        """Variants that are mistakes of the laboratory."""
        return frozenset(i for i, variant in enumerate(self.variants) if variant.laboratory)

    def listed(self, variants: Iterable[int]) -> list[ListedVariant]:
        """Some of the variants by name and values of their shapes."""
        return [ListedVariant(self.variants[i].name, dict(self.values[i])) for i in variants]

    def present(self, chosen: Sequence[Candidate]) -> tuple[int, ...]:
        """Variants of the effects in the model: each effect's first."""
        names = [variant.name for variant in self.variants]
        return tuple(names.index(candidate.name) for candidate in chosen)


def linearise_candidates(fits: EffectFits, state: FitState, among: Sequence[ListedVariant] | None = None) -> CandidateColumns:
    """Linearise a fitted model along every candidate effect, at every value of its shapes.

    Args:
        fits: Study, candidates, priors.
        state: The fitted model.
        among: Candidates at values of their shapes; None: all. Further values that slopes suggest are always tried.
    """
    names = {candidate.name for candidate in state.chosen}
    others = [candidate for candidate in fits.setup.candidates if candidate.name not in names]
    # a fit moves on with the slopes at hand, and leaves the shapes of its effects alone
    active = fits.active(state.chosen) if state.chosen else None
    return candidate_columns(fits, state.linearisation, state.chosen, others, among, active)


def candidate_columns(
    fits: EffectFits,
    linearisation: Linearisation,
    chosen: Sequence[Candidate],
    candidates: Sequence[Candidate],
    among: Sequence[ListedVariant] | None = None,
    anew: Sequence[int] | None = None,
) -> CandidateColumns:
    """A linear model of the effects in a model and of other candidates.

    Args:
        fits: Study, candidates, priors.
        linearisation: Linearisation along all free directions of the model.
        chosen: The effects in the model.
        candidates: Other candidates, which are linearised along.
        among: Which of them, at values of their shapes; None: all.
        anew: Directions along which the model is linearised anew, at the same point; None: `linearisation` is taken.
    """
    study = fits.study
    first, later = first_passes(fits, candidates, among)
    active = linearisation.active if anew is None else tuple(anew)
    jobs = jobs_of(fits, linearisation.point, active, first)
    linearisations = []
    by_state: KnownSlopes = {}
    if anew is not None or jobs:
        point, others = jobs[0] if jobs else (linearisation.point, ())
        # neutral candidates move nothing, whatever their shapes: the model and the first of them are one linearisation
        [whole] = study.linearise_all([(point, others if anew is None else (*active, *others))], keep=by_state)
        linearisations = [whole.restricted_to(others)] if jobs else []
        linearisation = linearisation if anew is None else replace(whole.restricted_to(active), point=linearisation.point)
    varied = [label for candidate in fits.setup.candidates if candidate.has_variants for label in candidate.amplitudes]
    moving = study.index(list(dict.fromkeys(varied)))
    linearisations += study.linearise_neutral(jobs[1:], by_state, moving)
    gathered = _Columns(fits, linearisation)
    gathered.add_linearised(chosen, candidates)
    last = packed([*gathered.take(first, linearisations), *later], study.width)
    gathered.take(last, study.linearise_neutral(jobs_of(fits, linearisation.point, active, last), by_state, moving))
    return gathered.columns()


class _Columns:
    """Columns of a linear model and candidates on them, as they are gathered.

    Attributes:
        slopes: Blocks of columns (n, k).
        directions: Direction of every column.
        variants: Candidates at values of their shapes.
        values: These values by variant.
    """

    def __init__(self, fits: EffectFits, linearisation: Linearisation) -> None:
        self.fits, self.study, self.linearisation = fits, fits.study, linearisation
        self.slopes, self.directions = [linearisation.slopes], list(linearisation.active)
        self.variants: list[Variant] = []
        self.values: list[Mapping[str, float]] = []

    def append(self, slopes: np.ndarray, directions: Sequence[int]) -> range:
        """Append columns; gives their numbers."""
        begin = len(self.directions)
        self.slopes.append(slopes)
        self.directions += directions
        return range(begin, len(self.directions))

    def add(self, candidate: Candidate, columns: Sequence[int], values: Mapping[str, float]) -> None:
        """Add a candidate at values of its shapes, which share its prior odds."""
        laboratory = candidate.effect in LABORATORY_EFFECTS
        odds = (LABORATORY_LOG_ODDS if laboratory else PHYSICS_LOG_ODDS) - math.log(max(len(candidate.grid), 1))
        self.variants.append(Variant(candidate.name, tuple(columns), odds, laboratory))
        self.values.append(values)

    def add_linearised(self, chosen: Sequence[Candidate], candidates: Sequence[Candidate]) -> None:
        """Add the effects whose slopes the model's own linearisation has.

        Args:
            chosen: The effects in the model.
            candidates: Other candidates, of which those with nearly known parameters are added.
        """
        for candidate in (*chosen, *candidates):
            if is_nearly_known(self.fits, candidate):
                self.add_nearly_known(candidate)
            elif candidate in chosen:
                self.add(candidate, [self.linearisation.active.index(i) for i in self.study.index(candidate.labels)], {})

    def add_nearly_known(self, candidate: Candidate) -> None:
        """Add an effect whose parameters move a little in every fit.

        Second columns of the same slopes let them go further.
        """
        mine = self.study.index(candidate.amplitudes)
        slopes = self.linearisation.slopes[:, [self.linearisation.active.index(i) for i in mine]]
        self.add(candidate, self.append(slopes, mine), {})

    def take(
        self, passes: Sequence[Sequence[CandidateValues]], linearisations: Sequence[Linearisation]
    ) -> list[CandidateValues]:
        """Take the slopes along candidates at values of their shapes.

        Args:
            passes: Candidates and values.
            linearisations: Linearisations along them.

        Returns:
            Further values to try.
        """
        active, study = self.linearisation.active, self.study
        further: list[CandidateValues] = []
        for members, along in zip(passes, linearisations, strict=True):
            numbers = dict(zip(along.active, self.append(along.slopes, list(along.active)), strict=True))
            for candidate, values in members:
                amplitudes = study.index(candidate.amplitudes)
                if candidate.is_plausible_at(values):
                    self.add(candidate, [active.index(i) if i in active else numbers[i] for i in amplitudes], values)
                if candidate.shape_finder is not None and values in (candidate.grid or ({},)):
                    first = along.slopes[:, along.active.index(amplitudes[0])]
                    further += [
                        (candidate, {**values, **shape}) for shape in candidate.shape_finder(study, self.linearisation, first)
                    ]
                if candidate.phase_per_unit is not None:
                    joined = self.linearisation.joined_with(along.restricted_to(amplitudes[:1]))
                    self.add_far_shift(candidate, replace(joined, point=along.point))
        return further

    def add_far_shift(self, candidate: Candidate, linearisation: Linearisation) -> None:
        """Add an effect that shifts the phases of waves, if it is further away than slopes reach.

        `phase_shift_start` finds this out from the phases.

        Args:
            candidate: The candidate.
            linearisation: Linearisation whose last direction is the candidate's.
        """
        assert candidate.phase_per_unit is not None
        far = phase_shift_start(self.study, linearisation, candidate.amplitudes[0], candidate.phase_per_unit)
        if far is not None:
            factor = phase_shift_factor(self.study, candidate.phase_per_unit, far.values[candidate.amplitudes[0]])
            lines = (linearisation.slopes[:, -1].reshape(-1, 2) @ [1, 1j]) * factor
            secant = np.stack([lines.real, lines.imag], axis=1).reshape(-1, 1)
            self.add(candidate, self.append(secant, linearisation.active[-1:]), far.values)

    def columns(self) -> CandidateColumns:
        """The linear model of the gathered columns."""
        return CandidateColumns(
            linear_model(self.fits, self.linearisation, np.hstack(self.slopes), self.directions),
            tuple(range(len(self.fits.base))),
            tuple(self.variants),
            tuple(self.values),
            tuple(self.directions),
            np.repeat(np.arange(len(self.study.series)), self.study.dof.shape[1]),
            self.linearisation,
        )
