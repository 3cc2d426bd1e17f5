"""A stop that was lost on its way is found by the next iteration of whatever loop is running."""

import contextlib
import signal
import threading
import time
from types import SimpleNamespace

import jax.numpy as jnp
import optimistix as optx
import pytest

from calibration.fitting.levenberg_marquardt import descend
from calibration.fitting.normal_equations import ArrowMatrix
from calibration.residuals.abstract_residual import parameters_only
from jaxhydro.cli.console import progress
from jaxhydro.interrupts import ended_by_signals, stop_if_asked, stoppable_threads, stopping

SENT = [signal.SIGINT, signal.SIGTERM]


def lost(number: int) -> None:
    """A signal whose KeyboardInterrupt something swallows, as XLA does with what is raised in its callbacks."""
    with contextlib.suppress(KeyboardInterrupt):
        signal.raise_signal(number)


@pytest.mark.parametrize("sent", SENT)
def test_an_iteration_of_a_fit_finds_a_stop_that_was_lost(sent: int) -> None:
    def objective(unknowns, args):
        x = unknowns.shared
        matrix = ArrowMatrix(jnp.diag(9 * x**4), jnp.zeros((0, 2, 0)), jnp.zeros((0, 0, 0)))
        gradient = parameters_only(3 * x**2 * (x**3 - args))
        return optx.FunctionInfo.EvalGradHessian(0.5 * jnp.sum((x**3 - args) ** 2), gradient, matrix), None

    with ended_by_signals():
        fit = descend(objective, parameters_only(jnp.array([3.0, 5.0])), jnp.array([1.0, 2.0]), 1e-12)
        next(fit)
        lost(sent)
        with pytest.raises(KeyboardInterrupt):
            next(fit)


def test_a_report_of_progress_finds_it() -> None:
    now = SimpleNamespace(stage="whole records", iteration=1, name="J", objective=1.0, fraction=0.1)
    with ended_by_signals(), progress() as show:
        show(now)
        lost(signal.SIGTERM)
        with pytest.raises(KeyboardInterrupt):
            show(now)


def test_what_finishes_up_is_not_stopped_again_but_by_another_signal() -> None:
    with ended_by_signals():
        lost(signal.SIGTERM)
        with pytest.raises(KeyboardInterrupt):
            stop_if_asked()
        stopping()
        stop_if_asked()
        lost(signal.SIGINT)
        with pytest.raises(KeyboardInterrupt):
            stop_if_asked()
    with ended_by_signals():
        stop_if_asked()


def test_jobs_that_have_not_begun_are_dropped() -> None:
    """A block that a stop ends waits for the jobs under way, not for those in the queue."""
    begun: list[int] = []
    under_way = threading.Event()

    def job(number: int) -> None:
        begun.append(number)
        under_way.set()
        time.sleep(0.05)

    with pytest.raises(KeyboardInterrupt), stoppable_threads(1) as pool:
        for number in range(100):
            pool.submit(job, number)
        assert under_way.wait(5)
        raise KeyboardInterrupt
    assert len(begun) < 10
    with stoppable_threads(2) as pool:
        assert pool.submit(lambda: 3).result() == 3
