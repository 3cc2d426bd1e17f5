"""Likelihood of a calibration that was fitted to decays."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from calibration.campaign.load_campaign import Campaign
from calibration.fitting.decay_fit import prepare_fit, run_fit
from calibration.fitting.fit import Fit
from calibration.identifiability.information import WEAK_PRIOR_ROUNDING, pseudo_inverse
from calibration.identifiability.residual_spectra import Periodogram, fit_colours, periodogram, score_covariance
from calibration.identifiability.standard_deviations import gauss_newton_matrix
from calibration.residuals.abstract_residual import Unknowns
from calibration.residuals.decays import DecayProblem
from calibration.result import Calibration
from calibration.uncertainty.likelihood import WHITE_NOISE, Likelihood
from jaxhydro.environment import DOFS


def restored_fit(
    campaign: Campaign, began: Mapping[str, Any], ended: Mapping[str, float], report: Callable[..., None] = lambda *_: None
) -> Fit:
    """Fit of a finished calibration to decays, with its free parameters and priors.

    Releases and offsets, which a calibration does not keep, begin from the records.

    Args:
        campaign: The campaign.
        began: Values, of free parameters and others, that the calibration began from in place of the platform's.
        ended: Calibrated values by label.
        report: As in `prepare_fit`.
    """
    baseline = campaign.model.values
    # only what is not as declared, so that types stay, and what was compiled for the fit serves again
    start = {k: float(v) for k, v in began.items() if float(v) != float(baseline[k])}
    fit = prepare_fit(campaign, free=list(ended), start=start, report=report)
    coordinates = [p.transform.inverse(float(ended[p.label])) for p in fit.decays.problem.space.free]
    fit.unknowns = fit.unknowns._replace(shared=jnp.array(coordinates))
    return fit


def likelihood(campaign: Campaign, result: Calibration) -> Likelihood:
    """Compute the likelihood of a calibration to decays. The records' releases are fitted again.

    Args:
        campaign: The campaign.
        result: Result of `calibrate`.

    Returns:
        The likelihood about the calibrated values.
    """
    parameters = result.parameters
    fit = restored_fit(
        campaign,
        {**result.model.values, **{label: estimate.start for label, estimate in parameters.items()}},
        {label: estimate.value for label, estimate in parameters.items()},
    )
    run_fit(fit)
    return likelihood_of(fit)


@eqx.filter_jit
def _slopes(problem: DecayProblem, unknowns: Unknowns) -> tuple[Float[Array, "r c t"], Float[Array, "r c t k"]]:
    """Residual, and its derivatives to the shared coordinates and the record's own."""
    return jax.lax.map(lambda inputs: problem.slopes(unknowns.shared, *inputs), (unknowns.own, problem.data))


def likelihood_of(fit: Fit) -> Likelihood:
    """Compute the likelihood of a finished fit (`run_fit`).

    The errors of a channel are stationary in each record. They have one colour in all records, or in all that were released
    alike, whichever is likelier. They are independent between channels and between records.

    Args:
        fit: The finished fit.

    Returns:
        The likelihood about the fit.
    """
    data, weight, shared = fit.decays.problem.data, np.asarray(fit.decays.weight), len(fit.decays.problem.space.free)
    residual, slope = map(np.asarray, _slopes(fit.decays.problem, fit.unknowns))
    # the residual's own row and column, which `assemble` leaves out
    blocks = np.pad(np.einsum("rctk,rctl,rc->rkl", slope, slope, weight), ((0, 0), (0, 1), (0, 1)))
    information = gauss_newton_matrix(blocks, shared)
    size, own_count = len(information), slope.shape[-1] - shared
    ridge, width = np.asarray(fit.ridge) ** 2, fit.width
    prior = tuple(np.concatenate([x, np.zeros(size - shared)]) for x in (ridge, ridge**2 * width**2))
    back = pseudo_inverse(information + np.diag(prior[0]), WEAK_PRIOR_ROUNDING)
    periodograms: dict[tuple[str, str], list[tuple[int, int, Periodogram]]] = {}
    for i, record in enumerate(fit.decays.records):
        indices = np.r_[:shared, shared + i * own_count : shared + (i + 1) * own_count]
        inverse, n = back[np.ix_(indices, indices)], len(record.time)
        for j, dof in enumerate(data.dofs):
            if weight[i, j] == 0 or DOFS[dof] not in record.values:
                continue
            wave = np.fft.rfft(slope[i, j, :n], axis=0)
            leverage = weight[i, j] * np.einsum("fk,kl,fl->f", wave.conj(), inverse, wave).real / n
            spectrum = periodogram(residual[i, j, :n], leverage, step_of(record.time))
            periodograms.setdefault((str(record.degree_of_freedom), DOFS[dof]), []).append((i, j, spectrum))
    colour, blocks, flat = {}, np.zeros_like(blocks), np.zeros_like(blocks)
    for channel in dict.fromkeys(channel for _, channel in periodograms):
        kinds = [kind for kind in periodograms if kind[1] == channel]
        for kind, (fitted, variances) in zip(
            kinds, fit_colours([[spectrum for *_, spectrum in periodograms[kind]] for kind in kinds]), strict=True
        ):
            colour[kind] = fitted
            for (i, j, spectrum), variance in zip(periodograms[kind], variances, strict=True):
                time = fit.decays.records[i].time
                for into, power, noise in ((blocks, float(variance), fitted), (flat, spectrum.variance, WHITE_NOISE)):
                    part = score_covariance(slope[i, j, : len(time)], power, noise, step_of(time))
                    into[i, :-1, :-1] += weight[i, j] ** 2 * part
    scatters = [gauss_newton_matrix(blocks, shared), gauss_newton_matrix(flat, shared)]
    covariance, white = (back @ (scatter + np.diag(prior[1])) @ back for scatter in scatters)
    spectra = {(i, j): spectrum for group in periodograms.values() for i, j, spectrum in group}
    return Likelihood(fit, slope, residual, information, scatters[0], (prior[0], prior[1]), covariance, white, colour, spectra)


def step_of(time: np.ndarray) -> float:
    """Sampling interval (s), taken as even."""
    return float((time[-1] - time[0]) / (len(time) - 1))
