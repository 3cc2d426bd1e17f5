"""Notes on a sweep before it runs: as `jaxhydro simulate` notes on one sea, for all of them."""

from collections.abc import Iterator

import jax.numpy as jnp
import numpy as np
from jaxtyping import Float

from jaxhydro.dynamics.model import Model
from jaxhydro.dynamics.sea_of_request import NOTED_SHARE, usual_cutoff
from jaxhydro.dynamics.table_ranges import TableRange, table_ranges
from jaxhydro.environment import Environment
from jaxhydro.interrupts import stop_if_asked
from jaxhydro.remarks import Remark
from jaxhydro.sweep.batch import Setup, failure_reason, sea_of
from jaxhydro.sweep.cases import Plan, Run
from jaxhydro.sweep.sea_states import State, named
from jaxhydro.waves.irregular import harmonics, repeat_period
from jaxhydro.waves.sea_limits import LIMITS
from jaxhydro.waves.spectra import SPECTRA, peak_enhancement

STATES_IN_MEMORY = 256  # sea states whose spectra are in memory


def shares_in_band(plan: Plan) -> Float[np.ndarray, " c"]:
    """Fraction of each case's spectrum within the band, (case,).

    It is the variance from `low` to `cutoff`, on the frequencies of the seas, over Hs²/16.
    """
    step = 2 * np.pi / repeat_period(plan.duration)
    shares = {state: float(density.sum()) * step / (state.height**2 / 16) for state, _, density in _spectra(plan)}
    return np.array([shares[case.state] for case in plan.cases])


def _spectra(plan: Plan) -> Iterator[tuple[State, Float[np.ndarray, " w"], Float[np.ndarray, " w"]]]:
    """Sea states, their frequencies (rad/s) in the band, and their spectra there (m² s/rad)."""
    period = repeat_period(plan.duration)
    first, last = harmonics(plan.low, plan.cutoff, period)
    omega = jnp.asarray(2 * np.pi / period * np.arange(first, last + 1))
    states = list(dict.fromkeys(case.state for case in plan.cases))
    for i in range(0, len(states), STATES_IN_MEMORY):
        chunk = states[i : i + STATES_IN_MEMORY]
        hs, tp = (jnp.array([state[k] for state in chunk])[:, None] for k in (0, 1))
        asked = jnp.array([[np.nan if state[2] is None else state[2]] for state in chunk])
        gamma = jnp.where(jnp.isnan(asked), peak_enhancement(hs, tp), asked)
        shape = plan.spectrum.replace("_", "-")
        density = SPECTRA[shape](omega, hs, tp, gamma)
        for state, sea in zip(chunk, np.asarray(density)):
            swell = state.systems(0.0, shape, None)[1:]
            yield state, np.asarray(omega), sum((np.asarray(system.density(omega)) for system in swell), sea)


def outside(plan: Plan, model: Model, failing: dict[State, str]) -> Iterator[Remark]:
    """Remarks on waves outside the model's tables, for the sea state with most energy there."""
    ranges = table_ranges(model)
    if not ranges:
        return
    shares: dict[TableRange, dict[State, float]] = {table: {} for table in ranges}
    for state, omega, density in _spectra(plan):
        if state not in failing:
            for table in ranges:
                shares[table][state] = table.share_outside(omega, density)
    for table, by_state in shares.items():
        remarks = {
            state: remark for state, share in by_state.items() if (remark := table.remark(share, named(state))) is not None
        }
        if remarks:
            state = max(remarks, key=by_state.__getitem__)
            others = f" (so or less {_in(len(remarks), len(by_state))})" if len(by_state) > 1 else ""
            yield remarks[state]._replace(text=remarks[state].text + others)


def near_limits(plan: Plan, environment: Environment, failing: dict[State, str]) -> Iterator[Remark]:
    """Remarks on sea states near the limits of wave theory.

    Each is for the steepest sea state that it is about.
    """
    states = [state for state in dict.fromkeys(case.state for case in plan.cases) if state not in failing]
    states.sort(key=lambda state: state.height / state.peak_period**2, reverse=True)
    for limit in LIMITS:
        remarks = {
            state: remark
            for state in states
            if (remark := limit(state.height, period := state.peak_period, environment, plan.order, plan.duration / period))
        }
        if remarks:
            state, remark = next(iter(remarks.items()))
            others = f" (so {_in(len(remarks), len(states))})" if len(states) > 1 else ""
            yield remark._replace(text=f"{named(state)}: {remark.text}{others}")


def impossible(setup: Setup) -> dict[State, str]:
    """Reasons why the runs of some sea states will fail: breaking waves, or hardly any energy in the band."""
    reasons: dict[State, str] = {}
    for state, case in {case.state: case for case in setup.plan.cases}.items():
        stop_if_asked()
        try:
            sea_of(setup, Run(0, 0, 0, case, setup.plan.seeds[0]))
        except Exception as error:  # whatever it is, it is this sea state's
            reasons[state] = failure_reason(error)
    return reasons


def notes(plan: Plan, model: Model, shares: Float[np.ndarray, " c"], failing: dict[State, str]) -> Iterator[str]:
    """Notes on a plan, a sentence or two each.

    Args:
        plan: The plan.
        model: The platform.
        shares: `shares_in_band` of its cases.
        failing: `impossible` sea states.
    """
    seas = {case.state: float(share) for case, share in zip(plan.cases, shares)}
    if failing:
        state, reason = next(iter(failing.items()))
        life = sum(case.probability for case in plan.cases if case.state in failing)
        more = f" and {len(failing) - 1} more" if len(failing) > 1 else ""
        yield (
            f"{len(failing)} of {len(seas)} sea states, {life:.2%} of the life, cannot be, and the runs fail. "
            f"{'They are' if more else 'It is'} {named(state)} ({reason}){more}"
        )
    run = {state: share for state, share in seas.items() if state not in failing}
    yield from _of_band(run, len(seas), plan)
    yield from _of_height(run, len(seas), plan, model)
    if model.cylinders is None and model.conventions.diffraction != "none":
        yield "no member of this platform diffracts waves: 1 + Ca everywhere"


def _of_band(seas: dict[State, float], total: int, plan: Plan) -> Iterator[str]:
    if cut := {state: share for state, share in seas.items() if share < NOTED_SHARE}:
        state = min(cut, key=cut.__getitem__)
        yield (
            f"{_in(len(cut), total)} less than {NOTED_SHARE:.0%} of the spectrum lies from {plan.low:g} to {plan.cutoff:g} Hz, "
            f"and the rest is left out. The share is least in {named(state)}, {cut[state]:.1%} or "
            f"Hs {state.height * cut[state] ** 0.5:.3g} m: see low and cutoff"
        )


def _of_height(seas: dict[State, float], total: int, plan: Plan, model: Model) -> Iterator[str]:
    gravity = float(model.environment.gravity)
    usual = {state: usual_cutoff(state.height * share**0.5, gravity) for state, share in seas.items()}
    if plan.order == 2 and (high := {state: cutoff for state, cutoff in usual.items() if cutoff < plan.cutoff}):
        state = min(high, key=high.__getitem__)
        yield (
            f"second order is usually cut off at sqrt(2 g / Hs) (Stansberg): {_in(len(high), total)} below "
            f"{plan.cutoff:g} Hz, at {high[state]:.2g} Hz in {named(state)}. Beyond, short waves bind more than they have: see "
            "cutoff"
        )


def _in(count: int, total: int) -> str:
    return "in the only sea state" if total == 1 else f"in {count} of {total} sea states"
