"""Posterior samples by NUTS, through numpyro (an extra: pip install jaxhydro[nuts])."""

import threading
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor, wait
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float
from scipy.linalg import cholesky, eigh

from calibration.fitting.cores import cores
from calibration.residuals.abstract_residual import Unknowns
from calibration.residuals.decays import DecayProblem
from calibration.uncertainty.likelihood import Likelihood, coordinates
from calibration.uncertainty.posterior_samples import Samples
from jaxhydro.interrupts import stop_if_asked, stopping

MAX_TREE_DEPTH = 6  # a tree of 63 steps: where the density bends, deeper ones take hours
MIN_DRAWS = 50  # draws of every chain that are worth keeping where it is stopped
POLL_INTERVAL = 0.5  # s between looks at the chains


Energy = Callable[[Float[Array, " n"]], Float[Array, ""]]


def potential_energy(likelihood: Likelihood, scale: float) -> Energy:
    """Energy of all coordinates (n,): half of `scale` times the sum of squares, and half of the prior's.

    Every free parameter has a normal prior in its coordinate, wide unless the manifest says otherwise. So no Jacobian of the
    transforms enters. The gradient J^T W r is a column of the products that the fit works with. It takes one forward-mode
    pass, and nothing goes back through the solver.
    """
    fit, weight = likelihood.fit, jnp.asarray(likelihood.fit.decays.weight)
    mean, precision = fit.mean, jnp.asarray(1 / fit.width)
    problem, shape = fit.decays.problem, fit.unknowns.own.shape
    p = len(fit.unknowns.shared)

    def both(z: Float[Array, " n"]) -> tuple[Float[Array, ""], Float[Array, " n"]]:
        return _energy(problem, Unknowns(z[:p], z[p:].reshape(shape)), weight, mean, precision, scale)

    @jax.custom_vjp
    def energy(z: Float[Array, " n"]) -> Float[Array, ""]:
        return both(z)[0]

    energy.defvjp(both, lambda gradient, ct: (ct * gradient,))
    return energy


def _energy(problem: DecayProblem, unknowns: Unknowns, weight, mean, precision, scale):
    """Energy and its gradient."""
    p = len(mean)
    block = scale * jnp.einsum("rckl,rc->rkl", problem.products(unknowns), weight)
    off = precision * (unknowns.shared - mean)
    slope = jnp.concatenate([block[:, :p, -1].sum(0) + precision * off, block[:, p:-1, -1].ravel()])
    energy = 0.5 * (block[:, -1, -1].sum() + off @ off)
    # a motion that runs away is no place to be, rather than an error
    fine = jnp.isfinite(energy) & jnp.isfinite(slope).all()
    return jnp.where(fine, energy, jnp.inf), jnp.where(fine, slope, 0.0)


def sample(
    likelihood: Likelihood,
    draws: int = 500,
    warmup: int = 200,
    chains: int = 4,
    seed: int = 0,
    progress: Callable[[int, str], None] = lambda done, remark: None,
) -> Samples:
    """Draw from the posterior by the no-U-turn sampler (NUTS).

    The density is exp(-energy) of `potential_energy`, with the same sum of squares as the profile's. Coordinates are
    whitened by the fit's information, so that steps are long and few. Errors that are neither white nor of known size are
    taken into account as in the profile. Every draw's distance from the estimate is stretched along the common directions
    of both covariances. The draws' covariance near the estimate is then the sandwich's. Chains run side by side, as many
    as there are cores. Stopped by the user (KeyboardInterrupt) it returns the draws of all chains, if each has `MIN_DRAWS`.

    Args:
        likelihood: Likelihood of a finished fit.
        draws: Draws of each chain.
        warmup: Steps of each chain that are left out.
        chains: Number of chains.
        seed: Seed of the random numbers.
        progress: Function that is called with the number of draws done, and a remark.

    Returns:
        The draws.

    Raises:
        ImportError: If numpyro is not installed.

    References:
        Hoffman and Gelman 2014, Journal of Machine Learning Research 15, 1593-1623. Shaby 2014, Journal of Computational
        and Graphical Statistics 23, 853-876, equation 7 (open-faced sandwich).
    """
    try:
        from numpyro.diagnostics import effective_sample_size, split_gelman_rubin
        from numpyro.infer import NUTS
    except ImportError as error:
        raise ImportError("sampling needs numpyro: pip install 'jaxhydro[nuts]'") from error
    fit, centre, scale = likelihood.fit, coordinates(likelihood.fit.unknowns), likelihood.scale()
    root, stretch = whitening(likelihood, scale)
    energy = potential_energy(likelihood, scale)
    away, unseen = jnp.asarray(root), jnp.asarray(np.diag(likelihood.information) <= 0).at[: len(likelihood.labels)].set(False)

    @jax.jit
    def whitened(z: Float[Array, " n"]) -> Float[Array, ""]:
        off = away @ z
        # a channel that a record lacks would wander without end
        return energy(jnp.asarray(centre) + off) + 0.5 * jnp.sum(jnp.where(unseen, off, 0.0) ** 2)

    kernel, key = NUTS(potential_fn=whitened, max_tree_depth=MAX_TREE_DEPTH), jax.random.key(seed)
    start = jax.random.normal(jax.random.fold_in(key, 1), (chains, len(centre)))
    begun = [kernel.init(jax.random.fold_in(key, 2 + k), warmup, start[k], (), {}) for k in range(chains)]
    step = jax.jit(lambda state: kernel.sample(state, (), {}))
    rows = _run_chains(step, begun, warmup, draws, progress)
    z, lost = np.array([[position for position, _ in row] for row in rows]), sum(astray for row in rows for _, astray in row)
    shared = len(fit.decays.problem.space.free)
    coordinate = (centre + z @ (stretch @ root).T)[..., :shared]
    value = np.empty_like(coordinate)
    for i, parameter in enumerate(fit.decays.problem.space.free):
        value[..., i] = jax.vmap(parameter.transform.forward)(jnp.asarray(coordinate[..., i].ravel())).reshape(
            coordinate.shape[:-1]
        )
    r_hat, effective = (np.asarray(f(coordinate)) for f in (split_gelman_rubin, effective_sample_size))
    return Samples(likelihood.labels, coordinate, value, r_hat, effective, lost, seed, draws, likelihood)


def _run_chains(
    step: Callable[[Any], Any], begun: list[Any], warmup: int, draws: int, progress: Callable[[int, str], None]
) -> list[list[tuple[np.ndarray, bool]]]:
    """Positions of the chains after their warm-up, and whether each step diverged.

    All chains are cut to the number of draws of the shortest one.
    """
    rows: list[list[tuple[np.ndarray, bool]]] = [[] for _ in begun]
    done, stop = [0] * len(begun), threading.Event()

    def walk(k: int) -> None:
        state = begun[k]
        for i in range(warmup + draws):
            if stop.is_set():
                return
            state = step(state)
            if i >= warmup:
                rows[k].append((np.asarray(state.z), bool(state.diverging)))
            done[k] = i + 1

    with ThreadPoolExecutor(min(len(begun), cores())) as pool:
        under_way = {pool.submit(walk, k) for k in range(len(begun))}
        try:
            while under_way:
                over, under_way = wait(under_way, timeout=POLL_INTERVAL)
                stop_if_asked()
                for future in over:
                    future.result()
                progress(sum(done), "finding the step" if min(done) < warmup else "drawing")
        except BaseException as stopped:
            stop.set()
            stopping()
            pool.shutdown(cancel_futures=True)
            if not isinstance(stopped, KeyboardInterrupt) or min(map(len, rows)) < MIN_DRAWS:
                raise
    count = min(map(len, rows))
    return [row[:count] for row in rows]


def whitening(likelihood: Likelihood, scale: float) -> tuple[np.ndarray, np.ndarray]:
    """Whitening matrix L (n, n) of the energy, and the matrix Omega (n, n) that stretches to the sandwich.

    L L^T is the covariance that the energy has at the estimate, Omega L L^T Omega^T that of the sandwich. Omega is
    C V nu^1/2 V^T, with the common directions C' V = C V nu, V^T C V = 1.
    """
    precision = np.zeros(len(likelihood.information))
    precision[: len(likelihood.labels)] = 1 / likelihood.fit.width**2
    hessian = scale * likelihood.information + np.diag(precision)
    # what no record sees at all: a channel that one record lacks
    hessian[np.diag_indices_from(hessian)] += np.where(np.diag(hessian) > 0, 0.0, 1.0)
    covariance = np.linalg.inv(hessian)
    covariance = 0.5 * (covariance + covariance.T)
    meat = scale**2 * likelihood.scatter + np.diag(np.where(np.diag(likelihood.information) > 0, precision, np.diag(hessian)))
    ratio, common = eigh(covariance @ meat @ covariance, covariance)
    stretch = covariance @ common @ np.diag(np.sqrt(np.maximum(ratio, 0.0))) @ common.T
    return cholesky(covariance, lower=True), stretch
