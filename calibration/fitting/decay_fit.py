"""Fit to decays: least squares on all decay records together, in stages."""

from collections.abc import Callable, Mapping, Sequence

import numpy as np
from jaxtyping import Array, Float

from calibration.campaign.load_campaign import Campaign
from calibration.campaign.manifest_sections import IN_WAVES
from calibration.campaign.records import Record
from calibration.fitting.decay_part import DecayPart
from calibration.fitting.fit import Fit, Report
from calibration.fitting.normal_equations import cost_of
from calibration.parameters.space import ParameterSpace, match_free_labels, parameter_space
from calibration.residuals.abstract_residual import Unknowns
from calibration.residuals.decays import DecayProblem, crossing_period, first_guess, gather_decays
from jaxhydro.dynamics.model import Model
from jaxhydro.dynamics.statics import equilibrium, natural_modes
from jaxhydro.dynamics.time_steps import memory_step
from jaxhydro.environment import DOFS
from jaxhydro.errors import InputError
from jaxhydro.errors import Problem as Wrong
from jaxhydro.quick_jit import as_data, on_device

WINDOW_GROWTH = 2.5  # the window grows by this factor, from FIRST_WINDOW_CYCLES cycles to the whole record
FIRST_WINDOW_CYCLES = 1.25
STEPS_PER_PERIOD = 16  # of the shortest natural period: an error of some 1e-7 in the period


def prepare_fit(
    campaign: Campaign,
    *,
    free: Sequence[str] | None = None,
    start: dict[str, float] | None = None,
    begin: dict[str, float] | None = None,
    report: Callable[[str, int, float, float], None] = lambda *_: None,
) -> Fit:
    """Set up a calibration to decays, before its first step.

    Arguments and InputError are those of `decay_calibration.calibrate`.
    """
    source = str(campaign.folder / "campaign.yaml")
    records = [record for record in campaign.used("fit") if record.kind == "decay"]
    if not records:
        uses = ", ".join(sorted({f"{r.kind} marked {r.use}" for r in campaign.records})) or "no tests"
        waves = any(r.kind in IN_WAVES and r.use == "fit" for r in campaign.records)
        hint = "Tests in waves are fitted by `jaxhydro calibrate --tests waves`, `calibrate_in_waves`." if waves else ""
        raise InputError(source, [Wrong("tests", "at least one decay test marked `use: fit`", uses, hint)])
    for record in records:
        for channel in set(record.values) & set(DOFS[3:]):
            if (largest := float(np.abs(record.values[channel]).max())) > np.pi / 2:
                where, angle = f"tests, {record.id}, channel {channel}", f"{np.degrees(largest):.3g} deg"
                raise InputError(source, [Wrong(where, "angles below 90 deg", angle, "Is the unit right?")])
    baseline = campaign.model
    labels = labels_of(campaign, baseline, [str(record.degree_of_freedom) for record in records], free)
    first = baseline.with_values(start or {})
    problem = set_up_decays(first, campaign, records, space_of(campaign, labels, first))
    x = on_device([p.transform.inverse((begin or {}).get(p.label, p.start)) for p in problem.space.free])
    return fit_of_decays(problem, records, x, report)


def fit_of_decays(
    problem: DecayProblem, records: Sequence[Record], x: Float[Array, " p"], report: Report = lambda *_: None
) -> Fit:
    """Fit to decays that begins at coordinates (p,), and from a first guess of the releases."""
    unknowns = Unknowns(as_data(x), first_guess(records, problem.data))
    return Fit([DecayPart(problem, records)], unknowns, report, lambda fit: fit.decays.objective())


def labels_of(campaign: Campaign, baseline: Model, moved: Sequence[str], free: Sequence[str] | None) -> tuple[str, ...]:
    """Labels of the free parameters.

    Args:
        campaign: The campaign.
        baseline: The model before the fit.
        moved: Released motions, whose parameters are free by default.
        free: Labels and patterns in place of the manifest's; None: the manifest's.

    Raises:
        InputError: There is no free parameter.
    """
    source, wish = str(campaign.folder / "campaign.yaml"), campaign.manifest.calibrate
    labels = match_free_labels(baseline, moved, wish.free if free is None else free, wish.fixed, source)
    if not labels:
        none = f"none: the platform declares nothing that acts on {', '.join(sorted(set(moved)))}"
        raise InputError(source, [Wrong("calibrate.free", "at least one free parameter", none)])
    return labels


def space_of(
    campaign: Campaign, labels: Sequence[str], begin: Model, priors: Mapping[str, tuple[float, float]] | None = None
) -> ParameterSpace:
    """Free parameters with the manifest's bounds and priors.

    Args:
        campaign: The campaign.
        labels: Labels of the parameters.
        begin: Model with the values to begin from.
        priors: Mean and standard deviation by label, for parameters without a prior in the manifest.

    Raises:
        InputError: A bound or prior is impossible.
    """
    wish = campaign.manifest.calibrate
    stated = {label: (prior.value, prior.standard_deviation) for label, prior in wish.priors.items()}
    source = str(campaign.folder / "campaign.yaml")
    return parameter_space(begin, labels, dict(wish.bounds), {**(priors or {}), **stated}, source)


def set_up_decays(model: Model, campaign: Campaign, records: Sequence[Record], space: ParameterSpace) -> DecayProblem:
    """Set up the residuals of a model against decay records."""
    periods = natural_modes(model).period
    step = float(periods.min()) / STEPS_PER_PERIOD
    # a model that starts with periods far too long would step too far for the true ones
    step = min([step, memory_step(model), *(crossing_period(record) / STEPS_PER_PERIOD for record in records)])
    data = gather_decays(records, model, step)
    rest = None if space.moves_equilibrium else equilibrium(model)
    return DecayProblem(model, space, data, campaign.manifest.zero is not None, rest)


def minimise_window(
    fit: Fit,
    stage: str,
    weight: np.ndarray,
    until: np.ndarray,
    tolerance: float,
    fraction: tuple[float, float],
    samples: float | None = None,
) -> bool:
    """Levenberg-Marquardt on a window of the decays, from where the fit is.

    Every free parameter has a prior about where it started, of VAGUE_DEVIATION unless the manifest says otherwise. It weighs as
    one observation among all independent ones: what the records do not determine stays where it was.

    Args:
        fit: A fit to decays.
        stage: Name of the stage.
        weight: Weights of the squares (r, c).
        until: End of the window (r,) in s.
        tolerance: As of `Fit.minimise`.
        fraction: As of `Fit.minimise`.
        samples: Number of independent observations; None for those of the window.

    Returns:
        Whether it ended before the limit of iterations.
    """
    decays = fit.decays
    # in units of the cost so far, so that damping and ridge mean the same in every stage
    decays.weight = weight / (1.0 if decays.products is None else cost_of((decays.products,), (weight,)))
    decays.problem = decays.problem.up_to(until)
    fit.ridge = 1 / fit.width / np.sqrt(decays.information if samples is None else samples)
    return fit.minimise(stage, tolerance, fraction)


def run_fit(fit: Fit, near: bool = False) -> None:
    """Run the stages of a fit to decays.

    Args:
        fit: The fit.
        near: Whether to stop after the first stage on whole records, which brings the fit near its end.
    """
    decays = fit.decays
    data, records = decays.problem.data, decays.records
    period, start = 2 * np.pi / np.asarray(data.pace), np.asarray(data.time)[:, 0]
    length = (decays.ends - start) / period
    even, cycles = np.array([record.test.weight for record in records]), FIRST_WINDOW_CYCLES
    windows = max(1, int(np.ceil(np.log(length.max() / FIRST_WINDOW_CYCLES) / np.log(WINDOW_GROWTH))))
    done = 0
    while cycles < length.max():
        until = decays.window(cycles)
        weight = decays.record_weights(even, until)
        stages = (0.4 * done / windows, 0.4 * (done + 1) / windows)
        minimise_window(fit, f"first {cycles:.3g} cycles", weight, until, 1e-2, stages)
        cycles, done = cycles * WINDOW_GROWTH, done + 1
    weight = decays.record_weights(even)
    minimise_window(fit, "whole records", weight, decays.ends, 1e-3, (0.4, 0.6))
    if near:
        return
    noise = np.array([[r.noise.get(DOFS[dof], np.inf) for dof in data.dofs] for r in records])
    measured = np.isfinite(noise) & (np.asarray(data.present).sum(axis=-1) > 0)
    for _ in range(3):
        error = np.sqrt(decays.residual_mean_squares())
        if (error[measured] < 1.2 * noise[measured]).all():
            weight = np.where(measured, 1 / noise**2, 0.0)
            minimise_window(fit, "noise level", weight, decays.ends, 2e-6, (0.8, 1.0), float(decays.samples.sum()))
            return
        main = np.where(decays.scored, np.maximum(error, noise) / decays.spread, 0).sum(axis=1)
        renewed = decays.record_weights(even / main)
        settled = np.allclose(renewed / renewed.max(), weight / weight.max(), rtol=0.02)
        weight = renewed
        minimise_window(fit, "sum of RMSE", weight, decays.ends, 1e-5, (0.6, 0.9))
        if settled:
            break
