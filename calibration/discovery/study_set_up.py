"""Study of a campaign with its candidates, nuisance parameters, scales and priors."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from calibration.campaign.load_campaign import Campaign
from calibration.campaign.manifest_sections import IN_WAVES
from calibration.discovery.campaign_study import study_of
from calibration.discovery.effects.candidates import Candidate, requested_table_labels, with_candidates, with_drag
from calibration.discovery.effects.catalogue import catalogue, zero_terms
from calibration.discovery.effects.catalogue_builder import noticeable_scales
from calibration.discovery.effects.nearly_known import PRETENSION, STIFFNESS
from calibration.discovery.effects.plausible_sizes import PlausibleSize, plausible_sizes
from calibration.discovery.effects.reference_sizes import Seas
from calibration.discovery.linearisations import Prior
from calibration.discovery.study import Study
from calibration.fitting.decay_fit import labels_of, space_of
from calibration.parameters.space import VAGUE_DEVIATION, FreeParameter, ParameterSpace
from calibration.parameters.transforms import LogInterval, Scaled
from calibration.residuals.moving_channels import moving_channels
from calibration.residuals.run_seas import sea_step, with_diffraction
from calibration.residuals.wave_options import Options
from jaxhydro.dynamics.model import Model
from jaxhydro.dynamics.statics import equilibrium, linearised
from jaxhydro.environment import DOFS
from jaxhydro.errors import InputError, Problem
from jaxhydro.loads import MooringLines

DIRECTIONS_AT_ONCE = 128  # directions differentiated at a time: few cost nearly as much as many
PLAUSIBLE_DEVIATIONS = 2.0  # prior standard deviations from a neutral value to the further end of its plausible range
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
        baseline: The model of the platform file.
        base: Labels of the model's free coefficients.
        nuisances: Names of nearly known parameters, free within their priors.
        prior: Priors of all directions.
        motions: The motions that the tests are about.
        plausible: Plausible sizes of the candidates' amplitudes by label.
        size_priors: Means and standard deviations of their priors where they are in the model, along their directions.
    """

    study: Study
    candidates: tuple[Candidate, ...]
    baseline: Model
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
    baseline = with_diffraction(campaign.model, options)
    labels = labels_of(campaign, baseline, sorted(motions), None)
    mass, stiffness = (np.asarray(m) for m in linearised(baseline, equilibrium(baseline)))
    variance = max((float(np.var(r.wave)) for r in waves if r.wave is not None), default=1.0)
    step = sea_step(baseline, options) if waves else 0.0
    scales = noticeable_scales(mass, stiffness, motions)
    seas = Seas.of(campaign.records, options.low, options.cutoff)
    peak_period = 0.0 if seas is None else seas.peak_period
    candidates, scaled, units = catalogue(baseline, scales, bool(waves), variance, step, peak_period)
    if not stiffness[2, 2] > MIN_HEAVE_STIFFNESS * float(baseline.body.mass * baseline.environment.gravity):
        # nothing holds up the weight of more mass: there would be no equilibrium
        candidates = [
            replace(candidate, amplitudes=tuple(x for x in candidate.amplitudes if x != MASS)) for candidate in candidates
        ]
        scaled.pop(MASS)
    for candidate in extra:
        if candidate.load is None or set(candidate.sizes) != set(candidate.amplitudes) or candidate.shapes:
            raise ValueError(f"{candidate.name}: one's own candidate has a load, a size of every amplitude, and no shapes")
        if candidate.dof is not None and candidate.dof not in DOFS:
            raise ValueError(f"{candidate.name}: a motion is one of {', '.join(DOFS)}, or None")
        if unknown := set(candidate.sizes) - set(candidate.load.values):
            raise ValueError(
                f"{candidate.name}: amplitudes are labels of its load's values, {', '.join(candidate.load.values)}; found "
                f"{', '.join(sorted(unknown))}"
            )
        for label, size in candidate.sizes.items():
            neutral = float(candidate.load.values[label])
            scaled[label], units[label] = FreeParameter(label, neutral, Scaled(neutral, 1.0), 0.0, math.inf), float(size)
    candidates = [*candidates, *extra]
    # what the platform file has is fitted, not looked for
    taken = set(baseline.values) - (requested_table_labels(baseline) - set(labels)) - zero_terms(baseline, labels)
    candidates = [candidate for candidate in candidates if not set(candidate.amplitudes) & taken]
    scaled = {label: parameter for label, parameter in scaled.items() if label not in taken}
    units = {label: unit for label, unit in units.items() if label not in taken}
    base_space = space_of(campaign, labels, baseline)
    nuisances: dict[str, tuple[dict[str, float], float]] = {}  # name -> parameters and how they go together, deviation
    free: list[FreeParameter] = [*base_space.free]
    for name in next(candidate.amplitudes for candidate in candidates if candidate.effect == "mass_properties"):
        nuisances[name] = ({name: 1.0}, MASS_PRIOR_WIDTH)
    # draught and trim are as the platform was ballasted, sensors zeroed afloat or not
    for dof in ("heave", "roll", "pitch"):
        if dof in motions and (dof == "heave" or len(motions) > 1):
            nuisances[f"static_offset.{dof}.force"] = ({f"static_offset.{dof}.force": 1.0}, TRIM_PRIOR_WIDTH)
    # catenaries stay as declared
    springs = [load for load in baseline.loads if isinstance(load, MooringLines)]
    lines = sorted(f"{load.prefix}.{line}" for load in springs for line in load.stiffness)
    if lines and not any(label.startswith("mooring.") for label in labels):
        values = {label: float(value) for label, value in baseline.values.items() if label.startswith("mooring.")}
        for name in values:
            value = values[name]
            free.append(FreeParameter(name, value, LogInterval(0.5 * value, 2 * value), 0.0, math.inf))
        tension = {line: _pretension(baseline, line) for line in lines}
        stretch = [tension[line] / values[f"{line}.stiffness"] / values[f"{line}.unstretched_length"] for line in lines]
        nuisances["mooring_stiffness"] = ({f"{line}.stiffness": 1.0 for line in lines}, STIFFNESS)
        share = PRETENSION * float(np.mean(stretch))
        nuisances["mooring_pretension"] = ({f"{line}.unstretched_length": 1.0 for line in lines}, max(share, 1e-5))
    plain = with_drag(baseline)
    ends = bool(waves) and bool((np.asarray(baseline.hull.ends.radius) == 0).any()) if baseline.hull.ends.label else False
    if ends:
        free.append(FreeParameter("covered_ends.share", 0.0, Scaled(0.0, 1.0), 0.0, math.inf))
        nuisances["covered_ends.share"] = ({"covered_ends.share": 1.0}, COVERED_ENDS_PRIOR_WIDTH)
    covered = ["covered_ends.share"] if ends else []
    model = with_candidates(plain, candidates, covered)
    nuisance_labels = {label for parts, _ in nuisances.values() for label in parts}
    plain = with_candidates(plain, [c for c in candidates if nuisance_labels & set(c.amplitudes)], covered)
    free += list(scaled.values())
    space = ParameterSpace(tuple(free))
    start = {parameter.label: parameter.start for parameter in space.free}
    model = model.at_values(start)
    plain = plain.at_values({label: value for label, value in start.items() if label in plain.values})
    names, rows = [], []
    column = {label: i for i, label in enumerate(space.labels)}
    prior_mean, prior_width = [], []
    x0 = np.asarray(space.start)

    def direction(name: str, parts: dict[str, float], mean: float, deviation: float) -> None:
        row = np.zeros(len(column))
        for label, weight in parts.items():
            row[column[label]] = weight * units.get(label, 1.0)
        names.append(name)
        rows.append(row)
        prior_mean.append(mean)
        prior_width.append(deviation)

    for parameter in base_space.free:
        has_prior = math.isfinite(parameter.prior_deviation)
        mean = parameter.prior_mean - float(x0[column[parameter.label]]) if has_prior else 0.0
        deviation = parameter.prior_deviation if has_prior else prior_width_of(parameter.label, baseline, bool(waves))
        direction(parameter.label, {parameter.label: 1.0}, mean, deviation)
    for name, (parts, deviation) in nuisances.items():
        direction(name, parts, 0.0, deviation)
    kept_effects = {"mass_properties"} if campaign.manifest.zero is not None else {"mass_properties", "static_offset"}
    candidates = [
        candidate
        for candidate in candidates
        if not set(candidate.amplitudes) <= set(nuisances) or candidate.effect in kept_effects
    ]
    plausible = plausible_sizes(baseline, candidates, scales, seas, campaign.manifest.plausible, source)
    reach = {
        label: (np.array([size_range.lower, size_range.upper]) - scaled[label].start) / units[label]
        for label, size_range in plausible.items()
    }
    size_priors = {}
    for label, size_range in plausible.items():
        mean = 0.0 if size_range.expected is None else (size_range.expected - scaled[label].start) / units[label]
        by_range = float(np.abs(reach[label]).max()) / PLAUSIBLE_DEVIATIONS
        size_priors[label] = mean, by_range if size_range.deviation is None else size_range.deviation / units[label]
    for candidate in candidates:
        for label in candidate.amplitudes:
            if label not in names:
                direction(label, {label: 1.0}, 0.0, size_priors[label][1])
        for label in candidate.shapes:
            shaped = isinstance(scaled[label].transform, LogInterval)
            direction(label, {label: 1.0}, 0.0, 0.7 if shaped else 3.0)
    limits = np.tile([-np.inf, np.inf], (len(names), 1))
    shapes = {label: ends for candidate in candidates for label, ends in candidate.shape_limits.items()}
    reach |= {label: (np.array(ends) - scaled[label].start) / units[label] for label, ends in shapes.items()}
    for label, span in reach.items():
        limits[names.index(label)] = np.sort(span)
    study = study_of(model, space, names, np.array(rows), campaign, options, width)
    study = replace(study, size_limits=limits, baseline=plain if waves else None)
    prior = Prior(np.array(prior_mean), np.array(prior_width))
    named = (tuple(candidates), baseline, tuple(labels), tuple(nuisances))
    return StudySetup(study, *named, prior, tuple(motions), plausible, size_priors)


def prior_width_of(label: str, baseline: Model, waves: bool) -> float:
    """Prior standard deviation of a coefficient's logarithm."""
    if not waves or float(baseline.values[label]) == 0:
        return VAGUE_DEVIATION
    return DAMPING_PRIOR_WIDTH if label.startswith("linear_damping.") else COEFFICIENT_PRIOR_WIDTH


def _pretension(model: Model, line: str) -> float:
    """Tension (N) of a mooring line in the reference position."""
    load = next(load for load in model.loads if isinstance(load, MooringLines))
    tension, _ = load.tension(np.zeros(6), np.eye(3))  # type: ignore[arg-type]
    return float(np.asarray(tension)[int(line.removeprefix("mooring.line")) - 1])
