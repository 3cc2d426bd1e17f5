"""What is to be known of a sweep before it runs: what `jaxhydro simulate` notes of one sea, of all of them."""

from collections import Counter
from collections.abc import Iterator

import jax.numpy as jnp
import numpy as np
from jaxtyping import Float

from jaxhydro.model import Model
from jaxhydro.sea_command import CUT, usual_cutoff
from jaxhydro.sweep.cases import Case, Plan
from jaxhydro.waves.irregular import repeat_period
from jaxhydro.waves.spectra import jonswap, peak_enhancement, pierson_moskowitz

AT_ONCE = 256  # sea states whose spectra are in memory


def shares_in_band(plan: Plan) -> Float[np.ndarray, " c"]:
    """Of every case: share of its spectrum's variance, Hs^2/16, from `low` to `cutoff`, on the frequencies of its seas."""
    period = repeat_period(plan.duration)
    harmonics = np.arange(max(np.ceil(plan.low * period - 1e-6), 1), np.floor(plan.cutoff * period + 1e-6) + 1)
    omega = jnp.asarray(2 * np.pi / period * harmonics)
    found: dict[tuple[float, float, float | None], float] = {}
    states = list(dict.fromkeys((case.hs, case.tp, case.gamma) for case in plan.cases))
    for i in range(0, len(states), AT_ONCE):
        some = states[i : i + AT_ONCE]
        hs, tp = (jnp.array([state[k] for state in some])[:, None] for k in (0, 1))
        if plan.spectrum == "jonswap":
            asked = jnp.array([[np.nan if state[2] is None else state[2]] for state in some])
            density = jonswap(omega, hs, tp, jnp.where(jnp.isnan(asked), peak_enhancement(hs, tp), asked))
        else:
            density = pierson_moskowitz(omega, hs, tp)
        share = density.sum(axis=1) * 2 * np.pi / period / (hs[:, 0] ** 2 / 16)
        found |= dict(zip(some, share.tolist()))
    return np.array([found[case.hs, case.tp, case.gamma] for case in plan.cases])


def notes(plan: Plan, model: Model, left_out: int) -> Iterator[str]:
    """One sentence each. `left_out` cases have probability 0."""
    if left_out:
        yield f"{_count(left_out, 'case')} of probability 0 {'are' if left_out > 1 else 'is'} left out"
    states = Counter(case._replace(heading=case.heading % 360, probability=0.0) for case in plan.cases)
    if twice := [state for state, count in states.items() if count > 1]:
        more = f" and {len(twice) - 1} more are" if len(twice) > 1 else " is"
        yield f"{_named(twice[0])}{more} in the table more than once: run as often, and shares add up"
    yield from _of_seas(plan, float(model.environment.gravity))
    if model.cylinders is None and model.diffraction != "none":
        yield "no member of this platform diffracts waves: 1 + Ca everywhere"


def _of_seas(plan: Plan, gravity: float) -> Iterator[str]:
    seas = {case[:3]: (float(share), case) for case, share in zip(plan.cases, shares_in_band(plan))}
    total, band = f"of {_count(len(seas), 'sea state')}", f"from {plan.low:g} to {plan.cutoff:g} Hz"
    if cut := [one for one in seas.values() if one[0] < CUT]:
        share, case = min(cut, key=lambda one: one[0])
        yield (
            f"in {len(cut)} {total} less than {CUT:.0%} of the spectrum lies {band}, and the rest is left out; least in "
            f"{_named(case)}, {share:.1%} or Hs {case.hs * share**0.5:.3g} m: see low and cutoff"
        )
    usual = [(usual_cutoff(case.hs * share**0.5, gravity), case) for share, case in seas.values()]
    if plan.order == 2 and (high := [one for one in usual if one[0] < plan.cutoff]):
        lowest, case = min(high, key=lambda one: one[0])
        yield (
            f"second order is usually cut off at sqrt(2 g / Hs) (Stansberg): in {len(high)} {total} below {plan.cutoff:g} Hz, "
            f"at {lowest:.2g} Hz in {_named(case)}. Beyond, short waves bind more than they have: see cutoff"
        )


def _named(case: Case) -> str:
    return f"Hs {case.hs:g} m, Tp {case.tp:g} s" + ("" if case.gamma is None else f", gamma {case.gamma:g}")


def _count(number: int, what: str) -> str:
    return f"{number} {what}{'s' * (number != 1)}"
