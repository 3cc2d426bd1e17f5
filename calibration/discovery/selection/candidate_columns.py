"""Columns of all candidate effects at a fitted point."""

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from calibration.discovery.effect_fits import EffectFits
from calibration.discovery.effects.candidates import Candidate
from calibration.discovery.effects.phase_shift_start import phase_shift_factor, phase_shift_start
from calibration.discovery.fit_state import FitState
from calibration.discovery.linearisations import Linearisation, Point
from calibration.discovery.search import ListedVariant
from calibration.discovery.selection.linear_model import LinearModel
from calibration.discovery.selection.study_linear_model import linear_model
from calibration.discovery.selection.subsets import Variant

CandidateValues = tuple[Candidate, Mapping[str, float]]  # a candidate at values of its shapes
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
    others = [one for one in candidates if not set(study.index(one.amplitudes)) <= set(fits.base)]
    # the finders of further shapes need slopes first; what those passes have no room for goes with what is found
    declared = [(one, at) for one in others for at in one.grid or ({},)]
    declared = [(one, at) for one, at in declared if among is None or any(is_listed(one, at, it) for it in among)]
    passes = packed(sorted(declared, key=lambda pair: pair[0].shape_finder is None), study.width)
    first = [some for some in passes if any(one.shape_finder is not None for one, _ in some)]
    later = [pair for some in passes[len(first) :] for pair in some]
    active = look.active if anew is None else tuple(anew)
    base = [] if anew is None else [(look.place, active)]
    seen = study.linearise_all([*base, *jobs_of(fits, look.place, active, first)])
    look, seen = (look, seen) if anew is None else (seen[0], seen[1:])
    gathered = _Columns(fits, look)
    for one in (*chosen, *candidates):
        if set(study.index(one.amplitudes)) <= set(fits.base):
            gathered.add_nearly_known(one)
        elif one in chosen:
            gathered.add(one, [look.active.index(i) for i in study.index(one.labels)], {})
    last = packed([*gathered.take(first, seen), *later], study.width)
    gathered.take(last, study.linearise_all(jobs_of(fits, look.place, active, last)))
    return CandidateColumns(
        linear_model(fits, look, np.hstack(gathered.slopes), gathered.directions),
        tuple(range(len(fits.base))),
        tuple(gathered.variants),
        tuple(gathered.values),
        tuple(gathered.directions),
        np.repeat(np.arange(len(fits.study.series)), fits.study.dof.shape[1]),
        look,
    )


def jobs_of(
    fits: EffectFits, place: Point, active: Sequence[int], passes: Sequence[Sequence[CandidateValues]]
) -> list[tuple[Point, tuple[int, ...]]]:
    """Points and directions of passes along candidates.

    Args:
        fits: Study, candidates, priors.
        place: The point of the model.
        active: The model's own directions, which are left out.
        passes: Candidates and values of their shapes.
    """
    jobs = []
    for some in passes:
        there = fits.with_values(place, {k: v for _, at in some for k, v in at.items()})
        free = dict.fromkeys(i for one, _ in some for i in fits.study.index(one.amplitudes) if i not in active)
        jobs.append((there, tuple(free)))
    return jobs


def is_listed(one: Candidate, at: Mapping[str, float], entry: ListedVariant) -> bool:
    """Whether an entry of a list means a candidate at declared values of its shapes; one with other values means all."""
    other = entry.values not in (one.grid or ({},))
    return one.name == entry.name and (one.shape_finder is not None or other or entry.values == at)


def packed(some: Sequence[CandidateValues], width: int) -> list[list[CandidateValues]]:
    """Candidates at values of their shapes in as few passes as possible, in their order.

    A pass has every candidate at one of its values at most, and at most so many directions.

    Args:
        some: Candidates and values.
        width: Directions of a pass.
    """
    passes: list[list[CandidateValues]] = []
    for one, at in some:
        for there in passes:
            room = width - sum(len(other.amplitudes) for other, _ in there)
            if len(one.amplitudes) <= room and all(other is not one for other, _ in there):
                there.append((one, at))
                break
        else:
            passes.append([(one, at)])
    return passes


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
