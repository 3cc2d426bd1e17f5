"""What the bench measures of the package on one decay: simulations and their derivatives, as functions to be jitted.

The decay is VolturnUS-S of the built-in campaign as declared, released from 6 m of surge, 2 m of heave and 4 deg of
pitch at once. Every function takes the model's arrays and the coordinates of its eleven free parameters: nothing is a
constant.

    python -m benchmarks.bench_cases first SECONDS       what a user waits for: from platform file to motion, public API
    python -m benchmarks.bench_cases NAME,NAME SECONDS   tracing and compilation of these cases

prints CPU seconds, import apart, as JSON; the bench runs it in new processes, first with an empty compilation cache.
"""

import json
import sys
import time
from collections.abc import Callable
from pathlib import Path

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from calibration.parameters.space import default_free, parameter_space
from jaxhydro import Model, State, StillWater, equilibrium, free_decay, load_model
from jaxhydro.dynamics.integrate import integrate

PLATFORM = Path(__file__).resolve().parents[1] / "jaxhydro" / "campaigns" / "volturnus-s-decays" / "platform.yaml"
RELEASE = np.array([6.0, 0.0, 2.0, 0.0, np.deg2rad(4.0), 0.0])
STEPS = {"rk4": 0.5, "tsit5": 1.0, "diffrax": 1.0}  # s

Case = Callable[[Model, Float[Array, " p"]], Array]


class Decay:
    """The model and the coordinates of its free parameters, and `cases` by name."""

    def __init__(self, duration: float, step: float | None = None) -> None:
        self.model = load_model(str(PLATFORM))
        labels = default_free(self.model, ("surge", "heave", "pitch"))
        self.space = parameter_space(self.model, labels)
        self.start, self.rest = self.space.start, equilibrium(self.model) + RELEASE
        self.duration, self.step = duration, step
        self.arrays, self.static = eqx.partition(self.model, eqx.is_array)
        self.cases: dict[str, Case] = {}
        for method in STEPS:
            self.cases[method] = self._position(method, "forward")
        for method, suffix in (("tsit5", ""), ("diffrax", " by diffrax")):
            self.cases["jacobian" + suffix] = self._jacobian(method)
            self.cases["gradient" + suffix] = self._gradient(method)

    def _position(self, method: str, adjoint: str) -> Case:
        step = STEPS[method] if self.step is None else self.step
        count = round(self.duration / step)

        def position(arrays: Model, x: Float[Array, " p"]) -> Float[Array, "t 6"]:
            model = self.space.model(eqx.combine(arrays, self.static), x)
            state = State(self.rest, jnp.zeros(6), model.rest().memory)
            start, size = jnp.zeros(()), jnp.asarray(step)
            return integrate(model, StillWater(), state, start, size, count, method, adjoint).position[: count + 1]

        return position

    def _jacobian(self, method: str) -> Case:
        position = self._position(method, "forward")
        return lambda arrays, x: jax.jacfwd(lambda x: position(arrays, x))(x)

    def _gradient(self, method: str) -> Case:
        position = self._position(method, "reverse")
        scale = jnp.array([1.0, 1.0, 1.0, 50.0, 50.0, 50.0])
        return lambda arrays, x: jax.grad(lambda x: jnp.mean((position(arrays, x) * scale) ** 2))(x)

    def compiled(self, name: str) -> jax.stages.Compiled:
        return jax.jit(self.cases[name]).lower(self.arrays, self.start).compile()


def first_result(duration: float) -> dict[str, float]:
    """CPU and wall seconds from a platform file to a decay, as the command line and a notebook do it."""
    cpu, wall = time.process_time(), time.perf_counter()
    model = load_model(str(PLATFORM))
    free_decay(model, {"surge": 6.0, "heave": 2.0, "pitch": 0.07}, np.linspace(0.0, duration, round(5 * duration) + 1))
    return {"cpu": time.process_time() - cpu, "wall": time.perf_counter() - wall}


def compilations(names: list[str], duration: float) -> dict[str, float]:
    """CPU seconds that tracing and compiling takes."""
    decay, seconds = Decay(duration), {}
    for name in names:
        begun = time.process_time()
        decay.compiled(name)
        seconds[name] = time.process_time() - begun
    return seconds


if __name__ == "__main__":
    what, duration = sys.argv[1], float(sys.argv[2])
    print(json.dumps(first_result(duration) if what == "first" else compilations(what.split(","), duration)))
