"""Set-up of a study: motions, candidates, nuisance parameters, scales and priors."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from calibration.campaign.load_campaign import Campaign
from calibration.campaign.manifest import IN_WAVES
from calibration.discovery.effects.candidates import Candidate, requested_table_labels, with_candidates, with_drag
from calibration.discovery.effects.catalogue import catalogue
from calibration.discovery.effects.catalogue_builder import noticeable_scales
from calibration.discovery.effects.nearly_known import PRETENSION, STIFFNESS
from calibration.discovery.effects.plausible_sizes import PlausibleSize, plausible_sizes
from calibration.discovery.effects.reference_sizes import Seas
from calibration.discovery.gather import study_of
from calibration.discovery.linearisations import Prior
from calibration.discovery.study import Study
from calibration.fitting.decay_fit import labels_of, space_of
from calibration.parameters.space import VAGUE_DEVIATION, FreeParameter, ParameterSpace
from calibration.parameters.transforms import LogInterval, Scaled
from calibration.residuals.measured_seas import sea_step, with_diffraction
from calibration.residuals.moving_channels import moving_channels
from calibration.residuals.wave_options import Options
from jaxhydro.dynamics.model import Model
from jaxhydro.dynamics.statics import equilibrium, linearised
from jaxhydro.environment import DOFS
from jaxhydro.errors import InputError, Problem
from jaxhydro.loads import MooringLines

DIRECTIONS_AT_ONCE = 128  # directions differentiated at a time: few cost nearly as much as many
PLAUSIBLE_DEVIATIONS = 2.0  # prior standard deviations from a neutral value to the further end of its plausible range
TERMS = ("linear_damping.", "quadratic_damping.", "stiffness.", "added_mass.")  # that are candidates where they are zero
MASS = "mass_properties.mass"
MIN_HEAVE_STIFFNESS = 1e-9  # 1/m, over the weight: below, nothing restores heave
MASS_PRIOR_WIDTH = 1.0  # of mass properties, in the deviations of `nearly_known`
TRIM_PRIOR_WIDTH = 3.0  # of draught and trim, in noticeable sizes
COVERED_ENDS_PRIOR_WIDTH = 0.7  # of the share of covered ends
# of a coefficient's logarithm in waves, around its value from decays or the platform file: one standard deviation of a prior
# that is steep beyond three. Drag changes with the sea; linear damping does not
COEFFICIENT_PRIOR_WIDTH, DAMPING_PRIOR_WIDTH = 0.75, 0.5


class StudySetup(NamedTuple):
    """A study with its candidates and priors.

    Attributes:
        study: The study.
        candidates: Candidate effects.
        declared: The model of the platform file.
        base: Labels of the model's free coefficients.
        nuisances: Names of nearly known parameters, free within their priors.
        prior: Priors of all directions.
        motions: The motions that the tests are about.
        plausible: Plausible sizes of the candidates' amplitudes by label.
        size_priors: Means and standard deviations of their priors where they are in the model, along their directions.
    """

    study: Study
    candidates: tuple[Candidate, ...]
    declared: Model
    base: tuple[str, ...]
    nuisances: tuple[str, ...]
    prior: Prior
    motions: tuple[str, ...]
    plausible: Mapping[str, PlausibleSize]
    size_priors: Mapping[str, tuple[float, float]]


def motions_of(campaign: Campaign) -> dict[str, float]:
    """Motions that the tests are about, with their largest standard deviation in a test (m, rad)."""
    motions: dict[str, float] = {}
    for record in campaign.records:
        if record.use == "ignore":
            continue
        if record.kind == "decay":
            names = [str(record.degree_of_freedom)]
        elif record.kind in IN_WAVES:
            names = moving_channels({k: record.values[k] for k in DOFS if k in record.values})
        else:
            continue
        for name in names:
            motions[name] = max(motions.get(name, 0.0), float(np.std(record.values[name])))
    return {dof: motions[dof] for dof in DOFS if dof in motions}


def set_up_study(
    campaign: Campaign, options: Options, extra: Sequence[Candidate] = (), width: int = DIRECTIONS_AT_ONCE
) -> StudySetup:
    """Set up everything that a diagnosis needs.

    Args:
        campaign: The campaign.
        options: How seas are reconstructed.
        extra: The user's own candidate effects.
        width: Number of directions that are differentiated at a time.

    Raises:
        InputError: If the campaign has nothing to diagnose.
        ValueError: If a user's own candidate is incomplete.
    """
    source = str(campaign.folder / "campaign.yaml")
    motions = motions_of(campaign)
    used = [r for r in campaign.records if r.use == "fit" and (r.kind == "decay" or r.kind in IN_WAVES)]
    if not used:
        raise InputError(source, [Problem("tests", "at least one decay or test in waves marked `use: fit`", "none")])
    waves = [r for r in campaign.records if r.kind in IN_WAVES and r.use != "ignore"]
    declared = with_diffraction(campaign.model, options)
    labels = labels_of(campaign, declared, sorted(motions), None)
    mass, stiffness = (np.asarray(m) for m in linearised(declared, equilibrium(declared)))
    variance = max((float(np.var(r.wave)) for r in waves if r.wave is not None), default=1.0)
    step = sea_step(declared, options) if waves else 0.0
    scales = noticeable_scales(mass, stiffness, motions)
    candidates, scaled, units = catalogue(declared, scales, bool(waves), variance, step)
    if not stiffness[2, 2] > MIN_HEAVE_STIFFNESS * float(declared.body.mass * declared.environment.gravity):
        # nothing holds up the weight of more mass: there would be no equilibrium
        candidates = [replace(one, amplitudes=tuple(x for x in one.amplitudes if x != MASS)) for one in candidates]
        scaled.pop(MASS)
    for own in extra:
        if own.load is None or set(own.sizes) != set(own.amplitudes) or own.shapes:
            raise ValueError(f"{own.name}: one's own candidate has a load, a size of every amplitude, and no shapes")
        if own.dof is not None and own.dof not in DOFS:
            raise ValueError(f"{own.name}: a motion is one of {', '.join(DOFS)}, or None")
        if unknown := set(own.sizes) - set(own.load.values):
            raise ValueError(
                f"{own.name}: amplitudes are labels of its load's values, {', '.join(own.load.values)}; found "
                f"{', '.join(sorted(unknown))}"
            )
        for label, size in own.sizes.items():
            neutral = float(own.load.values[label])
            scaled[label], units[label] = FreeParameter(label, neutral, Scaled(neutral, 1.0), 0.0, math.inf), float(size)
    candidates = [*candidates, *extra]
    # what the platform file has is fitted, not looked for
    taken = set(declared.values) - (requested_table_labels(declared) - set(labels)) - zero_terms(declared, labels)
    candidates = [one for one in candidates if not set(one.amplitudes) & taken]
    scaled = {label: one for label, one in scaled.items() if label not in taken}
    units = {label: one for label, one in units.items() if label not in taken}
    base_space = space_of(campaign, labels, declared)
    nuisances: dict[str, tuple[dict[str, float], float]] = {}  # name -> parameters and how they go together, deviation
    free: list[FreeParameter] = [*base_space.free]
    for name in next(one.amplitudes for one in candidates if one.effect == "mass_properties"):
        nuisances[name] = ({name: 1.0}, MASS_PRIOR_WIDTH)
    # draught and trim are as the platform was ballasted, sensors zeroed afloat or not
    for dof in ("heave", "roll", "pitch"):
        if dof in motions and (dof == "heave" or len(motions) > 1):
            nuisances[f"static_offset.{dof}.force"] = ({f"static_offset.{dof}.force": 1.0}, TRIM_PRIOR_WIDTH)
    # catenaries stay as declared
    springs = [load for load in declared.loads if isinstance(load, MooringLines)]
    lines = sorted(f"{load.prefix}.{line}" for load in springs for line in load.stiffness)
    if lines and not any(label.startswith("mooring.") for label in labels):
        values = {label: float(value) for label, value in declared.values.items() if label.startswith("mooring.")}
        for name in values:
            value = values[name]
            free.append(FreeParameter(name, value, LogInterval(0.5 * value, 2 * value), 0.0, math.inf))
        tension = {line: _pretension(declared, line) for line in lines}
        stretch = [tension[line] / values[f"{line}.stiffness"] / values[f"{line}.unstretched_length"] for line in lines]
        nuisances["mooring_stiffness"] = ({f"{line}.stiffness": 1.0 for line in lines}, STIFFNESS)
        share = PRETENSION * float(np.mean(stretch))
        nuisances["mooring_pretension"] = ({f"{line}.unstretched_length": 1.0 for line in lines}, max(share, 1e-5))
    model = with_drag(declared)
    ends = bool(waves) and bool((np.asarray(declared.hull.ends.radius) == 0).any()) if declared.hull.ends.label else False
    if ends:
        free.append(FreeParameter("covered_ends.share", 0.0, Scaled(0.0, 1.0), 0.0, math.inf))
        nuisances["covered_ends.share"] = ({"covered_ends.share": 1.0}, COVERED_ENDS_PRIOR_WIDTH)
    model = with_candidates(model, candidates, ["covered_ends.share"] if ends else [])
    free += list(scaled.values())
    space = ParameterSpace(tuple(free))
    start = {one.label: one.start for one in space.free}
    model = model.at_values(start)
    names, rows = [], []
    place = {label: i for i, label in enumerate(space.labels)}
    prior_mean, prior_width = [], []
    x0 = np.asarray(space.start)

    def direction(name: str, parts: dict[str, float], mean: float, deviation: float) -> None:
        row = np.zeros(len(place))
        for label, weight in parts.items():
            row[place[label]] = weight * units.get(label, 1.0)
        names.append(name)
        rows.append(row)
        prior_mean.append(mean)
        prior_width.append(deviation)

    for one in base_space.free:
        known = math.isfinite(one.prior_deviation)
        mean = one.prior_mean - float(x0[place[one.label]]) if known else 0.0
        deviation = one.prior_deviation if known else prior_width_of(one.label, declared, bool(waves))
        direction(one.label, {one.label: 1.0}, mean, deviation)
    for name, (parts, deviation) in nuisances.items():
        direction(name, parts, 0.0, deviation)
    kept = {"mass_properties"} if campaign.manifest.zero is not None else {"mass_properties", "static_offset"}
    candidates = [one for one in candidates if not set(one.amplitudes) <= set(nuisances) or one.effect in kept]
    stated, seas = campaign.manifest.plausible, Seas.of(campaign.records, options.low, options.cutoff)
    plausible = plausible_sizes(declared, candidates, scales, seas, stated, source)
    reach = {label: (np.array([one.lower, one.upper]) - scaled[label].start) / units[label] for label, one in plausible.items()}
    size_priors = {}
    for label, found in plausible.items():
        mean = 0.0 if found.expected is None else (found.expected - scaled[label].start) / units[label]
        by_range = float(np.abs(reach[label]).max()) / PLAUSIBLE_DEVIATIONS
        size_priors[label] = mean, by_range if found.deviation is None else found.deviation / units[label]
    for candidate in candidates:
        for label in candidate.amplitudes:
            if label not in names:
                direction(label, {label: 1.0}, 0.0, size_priors[label][1])
        for label in candidate.shapes:
            shaped = isinstance(scaled[label].transform, LogInterval)
            direction(label, {label: 1.0}, 0.0, 0.7 if shaped else 3.0)
    limits = np.tile([-np.inf, np.inf], (len(names), 1))
    for label, span in reach.items():
        limits[names.index(label)] = np.sort(span)
    study = replace(study_of(model, space, names, np.array(rows), campaign, options, width), size_limits=limits)
    prior = Prior(np.array(prior_mean), np.array(prior_width))
    named = (tuple(candidates), declared, tuple(labels), tuple(nuisances))
    return StudySetup(study, *named, prior, tuple(motions), plausible, size_priors)


def zero_terms(declared: Model, labels: Sequence[str]) -> set[str]:
    """Labels of terms of the equation of motion that are declared zero and not fitted."""
    values = {label: float(value) for label, value in declared.values.items() if label.startswith(TERMS)}
    return {label for label, value in values.items() if value == 0} - set(labels)


def prior_width_of(label: str, declared: Model, waves: bool) -> float:
    """Prior standard deviation of a coefficient's logarithm."""
    if not waves or float(declared.values[label]) == 0:
        return VAGUE_DEVIATION
    return DAMPING_PRIOR_WIDTH if label.startswith("linear_damping.") else COEFFICIENT_PRIOR_WIDTH


def _pretension(model: Model, line: str) -> float:
    """Tension (N) of a mooring line in the reference position."""
    load = next(load for load in model.loads if isinstance(load, MooringLines))
    tension, _ = load.tension(np.zeros(6), np.eye(3))  # type: ignore[arg-type]
    return float(np.asarray(tension)[int(line.removeprefix("mooring.line")) - 1])
