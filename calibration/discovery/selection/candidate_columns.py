"""Columns of all candidate effects at a fitted point, and the linear model made of them."""

import math
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import count

import numpy as np

from calibration.discovery.acceptance import FitState
from calibration.discovery.effect_fits import EffectFits
from calibration.discovery.effects.candidates import Candidate
from calibration.discovery.effects.phase_shift_start import phase_shift_factor, phase_shift_start
from calibration.discovery.linearisations import Linearisation
from calibration.discovery.selection.joint_selection import JointSelection, Variant
from calibration.discovery.selection.linear_model import LinearModel, OwnUnknowns
from calibration.discovery.study import Study

MIN_SCREENED_GAIN = 6.0  # of -2 ln L by an earlier linearisation: slopes along an effect that gains less are not computed anew
MAX_COEFFICIENT_STEP = 1.0  # of a logarithm in one linearisation
MAX_NUISANCE = 3.0  # standard deviations of nearly known quantities
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
        candidates: Names of the candidates that are not in the model.
    """

    model: LinearModel
    base: tuple[int, ...]
    variants: tuple[Variant, ...]
    values: tuple[Mapping[str, float], ...]
    directions: tuple[int, ...]
    series: np.ndarray
    look: Linearisation
    candidates: frozenset[str]

    def present(self, chosen: Sequence[Candidate]) -> tuple[int, ...]:
        """Variants of the effects in the model: each effect's first."""
        names = [one.name for one in self.variants]
        return tuple(names.index(one.name) for one in chosen)


def linearise_candidates(fits: EffectFits, state: FitState, earlier: CandidateColumns | None = None) -> CandidateColumns:
    """Linearise a fitted model along every candidate effect, at every value of its shapes.

    Slopes along effects that a first-order gain does not speak for are taken from an earlier linearisation.

    Args:
        fits: Study, candidates, priors.
        state: The fitted model.
        earlier: An earlier linear model of all candidates.
    """
    look = state.look
    if state.chosen:  # a fit moves on with the slopes at hand, and leaves the shapes of its effects alone
        look = fits.study.linearise(look.place, fits.active(state.chosen))
    names = {one.name for one in state.chosen}
    others = [one for one in fits.setup.candidates if one.name not in names]
    if earlier is None:
        return candidate_columns(fits, look, state.chosen, others)
    known = earlier.candidates
    screening = candidate_columns(fits, look, state.chosen, [one for one in others if one.name in known], earlier)
    present = screening.present(state.chosen)
    selection = JointSelection(screening.model, screening.base, screening.variants, screening.series)
    gains = selection.first_order_gains(selection.subset(present))
    anew = {screening.variants[i].name for i, gain in gains.items() if gain > MIN_SCREENED_GAIN}
    return candidate_columns(fits, look, state.chosen, others, earlier, anew | ({one.name for one in others} - known))


def candidate_columns(
    fits: EffectFits,
    look: Linearisation,
    chosen: Sequence[Candidate],
    candidates: Sequence[Candidate],
    earlier: CandidateColumns | None = None,
    anew: Collection[str] = (),
) -> CandidateColumns:
    """A linear model of the effects in a model and of other candidates.

    Args:
        fits: Study, candidates, priors.
        look: Linearisation along all free directions of the model.
        chosen: The effects in the model.
        candidates: Other candidates, which are linearised along.
        earlier: An earlier linear model, whose slopes are used along all but some candidates.
        anew: Names of these.
    """
    study = fits.study
    columns, directions = [look.slopes], list(look.active)
    base = tuple(range(len(fits.base)))
    variants: list[Variant] = []
    values: list[Mapping[str, float]] = []

    def add(one: Candidate, mine: Sequence[int], at: Mapping[str, float]) -> None:
        odds = LABORATORY_LOG_ODDS if one.effect in LABORATORY_EFFECTS else PHYSICS_LOG_ODDS
        variants.append(Variant(one.name, tuple(mine), odds))
        values.append(at)

    others = []
    for one in (*chosen, *candidates):
        mine = study.index(one.amplitudes)
        if set(mine) <= set(fits.base):  # nearly known, and let go further by a second column with the same slopes
            at = [look.active.index(i) for i in mine]
            add(one, range(len(directions), len(directions) + len(at)), {})
            columns.append(look.slopes[:, at])
            directions += mine
        elif one in chosen:
            add(one, [look.active.index(i) for i in study.index(one.labels)], {})
        elif earlier is not None and one.name not in anew:
            for variant, shapes in zip(earlier.variants, earlier.values, strict=True):
                if variant.name == one.name:
                    add(one, range(len(directions), len(directions) + len(variant.columns)), shapes)
                    columns.append(earlier.model.slopes[:, list(variant.columns)])
                    directions += [earlier.directions[c] for c in variant.columns]
        else:
            others.append(one)
    grids = {one.name: one.grid or ({},) for one in others}
    for g in count():
        if not (todo := [one for one in others if g < len(grids[one.name])]):
            break
        place = fits.with_values(look.place, {k: v for one in todo for k, v in grids[one.name][g].items()})
        free = dict.fromkeys(i for one in todo for i in study.index(one.amplitudes) if i not in look.active)
        seen = study.linearise(place, list(free))
        begin = len(directions)
        columns.append(seen.slopes)
        directions += seen.active
        for one in todo:
            mine = [
                look.active.index(i) if i in look.active else begin + seen.active.index(i) for i in study.index(one.amplitudes)
            ]
            add(one, mine, grids[one.name][g])
            if one.shape_finder is not None and g < len(one.grid):
                some = one.shape_finder(study, look, seen.slopes[:, mine[0] - begin])
                grids[one.name] += tuple({**one.grid[g], **shape} for shape in some)
            if one.phase_per_unit is not None:
                there = replace(look.joined_with(seen.restricted_to([directions[mine[0]]])), place=place)
                far = phase_shift_start(study, there, one.amplitudes[0], one.phase_per_unit)
                if far is not None:
                    factor = phase_shift_factor(study, one.phase_per_unit, far.values[one.amplitudes[0]])
                    lines = (seen.slopes[:, mine[0] - begin].reshape(-1, 2) @ [1, 1j]) * factor
                    columns.append(np.stack([lines.real, lines.imag], axis=1).reshape(-1, 1))
                    directions.append(directions[mine[0]])
                    add(one, [len(directions) - 1], far.values)
    return CandidateColumns(
        linear_model(fits, look, np.hstack(columns), directions),
        base,
        tuple(variants),
        tuple(values),
        tuple(directions),
        np.repeat(np.arange(len(study.series)), study.dof.shape[1]),
        look,
        frozenset(one.name for one in candidates),
    )


def linear_model(fits: EffectFits, look: Linearisation, slopes: np.ndarray, directions: Sequence[int]) -> LinearModel:
    """The linear model of some columns at a linearisation's point.

    Args:
        fits: Study, candidates, priors.
        look: The linearisation.
        slopes: The columns (n, k).
        directions: Their directions (k,).
    """
    study, prior = fits.study, fits.setup.prior
    directions, names = list(directions), np.array(study.names)[list(directions)]
    now = study.steps(look.place.x)[directions]
    low, high = (study.limits[directions] - now[:, None]).T
    base = np.arange(len(directions)) < len(fits.base)
    further = ~base & np.isin(directions, fits.base)  # of nearly known properties, beside the base's column
    width = np.array([fits.setup.size_width(n) if more else w for n, more, w in zip(names, further, prior.width[directions])])
    step = np.where(study.logarithmic[directions], MAX_COEFFICIENT_STEP, np.inf)
    low, high = np.maximum(low, -step), np.minimum(high, step)
    nuisance = base & np.isin(directions, study.index(fits.setup.nuisances))
    low = np.where(nuisance, np.minimum(np.maximum(low, -MAX_NUISANCE * width - now), 0.0), low)
    high = np.where(nuisance, np.maximum(np.minimum(high, MAX_NUISANCE * width - now), 0.0), high)
    positive = {label for one in fits.setup.candidates for label in one.positive}
    signed = ~base & np.isin(names, sorted(positive))
    low = np.where(signed, np.maximum(low, -now), low)
    amplitudes = {label for one in fits.setup.candidates for label in one.amplitudes}
    sized = ~base & ~further & np.isin(names, sorted(amplitudes))
    used = study.used[study.row_series]
    return LinearModel(
        slopes,
        look.residual,
        own_unknowns(study, look),
        study.pool,
        study.share * used,
        (study.pooled * study.used[:, None]).ravel(),
        np.where(further, 0.0, np.where(sized, -now, prior.mean[directions] - now)),
        width,
        low,
        high,
        np.where(sized, -now, 0.0),
        sized | further,
    )


def own_unknowns(study: Study, look: Linearisation) -> tuple[OwnUnknowns, ...]:
    """The fitted decays' own unknowns."""
    found = []
    for i, (rows, fitted) in enumerate(zip(study.spans, study.fitted_decays, strict=True)):
        there = look.own[rows].any(axis=0)
        if fitted and there.any():
            found.append(OwnUnknowns(rows, look.own[rows][:, there], study.own_width[i][there], look.place.own[i][there]))
    return tuple(found)
