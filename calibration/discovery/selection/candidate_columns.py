"""Columns of all candidate effects at a fitted point."""

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from calibration.discovery.effect_fits import EffectFits
from calibration.discovery.effects.candidates import Candidate
from calibration.discovery.effects.phase_shift_start import phase_shift_factor, phase_shift_start
from calibration.discovery.fit_state import FitState
from calibration.discovery.linearisations import Linearisation
from calibration.discovery.search import ListedVariant
from calibration.discovery.selection.candidate_passes import CandidateValues, first_passes, is_nearly_known, jobs_of, packed
from calibration.discovery.selection.linear_model import LinearModel
from calibration.discovery.selection.study_linear_model import linear_model
from calibration.discovery.selection.subsets import Variant
from calibration.discovery.study import KnownSlopes

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
        look: Linearisation along the base directions and the effects in the model.
    """

    model: LinearModel
    base: tuple[int, ...]
    variants: tuple[Variant, ...]
    values: tuple[Mapping[str, float], ...]
    directions: tuple[int, ...]
    series: np.ndarray
    look: Linearisation

    @property
    def laboratory(self) -> frozenset[int]:
        """Variants that are mistakes of the laboratory."""
        return frozenset(i for i, one in enumerate(self.variants) if one.laboratory)

    def listed(self, variants: Iterable[int]) -> list[ListedVariant]:
        """Some of the variants by name and values of their shapes."""
        return [ListedVariant(self.variants[i].name, dict(self.values[i])) for i in variants]

    def present(self, chosen: Sequence[Candidate]) -> tuple[int, ...]:
        """Variants of the effects in the model: each effect's first."""
        names = [one.name for one in self.variants]
        return tuple(names.index(one.name) for one in chosen)


def linearise_candidates(fits: EffectFits, state: FitState, among: Sequence[ListedVariant] | None = None) -> CandidateColumns:
    """Linearise a fitted model along every candidate effect, at every value of its shapes.

    Args:
        fits: Study, candidates, priors.
        state: The fitted model.
        among: Candidates at values of their shapes; None: all. Further values that slopes suggest are always tried.
    """
    names = {one.name for one in state.chosen}
    others = [one for one in fits.setup.candidates if one.name not in names]
    # a fit moves on with the slopes at hand, and leaves the shapes of its effects alone
    active = fits.active(state.chosen) if state.chosen else None
    return candidate_columns(fits, state.look, state.chosen, others, among, active)


def candidate_columns(
    fits: EffectFits,
    look: Linearisation,
    chosen: Sequence[Candidate],
    candidates: Sequence[Candidate],
    among: Sequence[ListedVariant] | None = None,
    anew: Sequence[int] | None = None,
) -> CandidateColumns:
    """A linear model of the effects in a model and of other candidates.

    Args:
        fits: Study, candidates, priors.
        look: Linearisation along all free directions of the model.
        chosen: The effects in the model.
        candidates: Other candidates, which are linearised along.
        among: Which of them, at values of their shapes; None: all.
        anew: Directions along which the model is linearised anew, at the same point; None: `look` is taken.
    """
    study = fits.study
    first, later = first_passes(fits, candidates, among)
    active = look.active if anew is None else tuple(anew)
    jobs = jobs_of(fits, look.place, active, first)
    looks = []
    known: KnownSlopes = {}
    if anew is not None or jobs:
        place, others = jobs[0] if jobs else (look.place, ())
        # neutral candidates move nothing, whatever their shapes: the model and the first of them are one linearisation
        [whole] = study.linearise_all([(place, others if anew is None else (*active, *others))], keep=known)
        looks = [whole.restricted_to(others)] if jobs else []
        look = look if anew is None else replace(whole.restricted_to(active), place=look.place)
    varied = [label for one in fits.setup.candidates if one.has_variants for label in one.amplitudes]
    moving = study.index(list(dict.fromkeys(varied)))
    looks += study.linearise_neutral(jobs[1:], known, moving)
    gathered = _Columns(fits, look)
    gathered.add_linearised(chosen, candidates)
    last = packed([*gathered.take(first, looks), *later], study.width)
    gathered.take(last, study.linearise_neutral(jobs_of(fits, look.place, active, last), known, moving))
    return gathered.columns()


class _Columns:
    """Columns of a linear model and candidates on them, as they are gathered.

    Attributes:
        slopes: Blocks of columns (n, k).
        directions: Direction of every column.
        variants: Candidates at values of their shapes.
        values: These values by variant.
    """

    def __init__(self, fits: EffectFits, look: Linearisation) -> None:
        self.fits, self.study, self.look = fits, fits.study, look
        self.slopes, self.directions = [look.slopes], list(look.active)
        self.variants: list[Variant] = []
        self.values: list[Mapping[str, float]] = []

    def append(self, slopes: np.ndarray, directions: Sequence[int]) -> range:
        """Append columns; gives their numbers."""
        begin = len(self.directions)
        self.slopes.append(slopes)
        self.directions += directions
        return range(begin, len(self.directions))

    def add(self, one: Candidate, columns: Sequence[int], values: Mapping[str, float]) -> None:
        """Add a candidate at values of its shapes, which share its prior odds."""
        laboratory = one.effect in LABORATORY_EFFECTS
        odds = (LABORATORY_LOG_ODDS if laboratory else PHYSICS_LOG_ODDS) - math.log(max(len(one.grid), 1))
        self.variants.append(Variant(one.name, tuple(columns), odds, laboratory))
        self.values.append(values)

    def add_linearised(self, chosen: Sequence[Candidate], candidates: Sequence[Candidate]) -> None:
        """Add the effects whose slopes the model's own linearisation has.

        Args:
            chosen: The effects in the model.
            candidates: Other candidates, of which those with nearly known parameters are added.
        """
        for one in (*chosen, *candidates):
            if is_nearly_known(self.fits, one):
                self.add_nearly_known(one)
            elif one in chosen:
                self.add(one, [self.look.active.index(i) for i in self.study.index(one.labels)], {})

    def add_nearly_known(self, one: Candidate) -> None:
        """Add an effect whose parameters move a little in every fit. Second columns of the same slopes let them go further."""
        mine = self.study.index(one.amplitudes)
        slopes = self.look.slopes[:, [self.look.active.index(i) for i in mine]]
        self.add(one, self.append(slopes, mine), {})

    def take(self, passes: Sequence[Sequence[CandidateValues]], looks: Sequence[Linearisation]) -> list[CandidateValues]:
        """Take the slopes along candidates at values of their shapes.

        Args:
            passes: Candidates and values.
            looks: Linearisations along them.

        Returns:
            Further values to try.
        """
        active, study = self.look.active, self.study
        further: list[CandidateValues] = []
        for some, seen in zip(passes, looks, strict=True):
            numbers = dict(zip(seen.active, self.append(seen.slopes, list(seen.active)), strict=True))
            for one, at in some:
                amplitudes = study.index(one.amplitudes)
                self.add(one, [active.index(i) if i in active else numbers[i] for i in amplitudes], at)
                if one.shape_finder is not None and at in (one.grid or ({},)):
                    first = seen.slopes[:, seen.active.index(amplitudes[0])]
                    further += [(one, {**at, **shape}) for shape in one.shape_finder(study, self.look, first)]
                if one.phase_per_unit is not None:
                    look = self.look.joined_with(seen.restricted_to(amplitudes[:1]))
                    self.add_far_shift(one, replace(look, place=seen.place))
        return further

    def add_far_shift(self, one: Candidate, look: Linearisation) -> None:
        """Add an effect that shifts the phases of waves, where phases say that it is further away than slopes reach.

        Args:
            one: The candidate.
            look: Linearisation whose last direction is the candidate's.
        """
        assert one.phase_per_unit is not None
        far = phase_shift_start(self.study, look, one.amplitudes[0], one.phase_per_unit)
        if far is not None:
            factor = phase_shift_factor(self.study, one.phase_per_unit, far.values[one.amplitudes[0]])
            lines = (look.slopes[:, -1].reshape(-1, 2) @ [1, 1j]) * factor
            secant = np.stack([lines.real, lines.imag], axis=1).reshape(-1, 1)
            self.add(one, self.append(secant, look.active[-1:]), far.values)

    def columns(self) -> CandidateColumns:
        """The linear model of what was gathered."""
        return CandidateColumns(
            linear_model(self.fits, self.look, np.hstack(self.slopes), self.directions),
            tuple(range(len(self.fits.base))),
            tuple(self.variants),
            tuple(self.values),
            tuple(self.directions),
            np.repeat(np.arange(len(self.study.series)), self.study.dof.shape[1]),
            self.look,
        )
