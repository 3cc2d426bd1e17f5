"""First-order wave components, and plane waves (free or bound) of any order."""

import dataclasses
import math

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, Complex, Float

from jaxhydro.environment import Environment
from jaxhydro.quick_jit import as_data, quick_jit
from jaxhydro.waves.dispersion import wavenumber


class Components(eqx.Module):
    """First-order wave components: eta = sum a cos(omega t - k (x cos heading + y sin heading) + phase).

    `first` is set where the frequencies are successive harmonics of a period, omega = (first, first + 1 ...) 2 pi / period,
    zero amplitudes included. Fourier transforms and sums over pairs need that. None: any frequencies. With `trains` 2 the same
    harmonics follow once more, as for incident and reflected waves.

    Attributes:
        amplitude: Amplitudes (m), (w,).
        omega: Angular frequencies (rad/s), (w,).
        wavenumber: Wavenumbers (rad/m), (w,).
        heading: Directions that the waves travel to (rad), from x towards y, (w,).
        phase: Phases (rad), (w,).
        first: Number of the first harmonic, or None.
        trains: Number of wave trains, each with the same harmonics, one after the other.
    """

    amplitude: Float[Array, " w"]  # m
    omega: Float[Array, " w"]  # rad/s
    wavenumber: Float[Array, " w"]  # rad/m
    heading: Float[Array, " w"]  # rad, where the waves travel to, from x towards y
    phase: Float[Array, " w"]  # rad
    first: int | None = eqx.field(static=True, default=None)
    trains: int = eqx.field(static=True, default=1)

    def __repr__(self) -> str:
        """Number, frequencies, height and headings; shapes where the numbers are not computed yet."""
        from jaxhydro.display.summaries import are_numbers, components_summary

        computed = are_numbers(self) and self.amplitude.ndim == 1
        return f"Components: {components_summary(self)}" if computed else eqx.Module.__repr__(self)

    @property
    def harmonics(self) -> tuple[int, int]:
        """Numbers of the first and the last harmonic.

        Raises:
            ValueError: The frequencies are not harmonics of a period.
        """
        if self.first is None:
            raise ValueError("the components are no successive harmonics of a period")
        return self.first, self.first + self.omega.size // self.trains - 1

    @property
    def period(self) -> Float[Array, ""]:
        """Time (s) after which the sea repeats itself.

        Raises:
            ValueError: The frequencies are not harmonics of a period.
        """
        return self.harmonics[0] * 2 * math.pi / self.omega[0]

    def vector(self) -> Float[Array, "2 w"]:
        """Wavenumber vectors (rad/m), (2, w)."""
        return self.wavenumber * jnp.stack([jnp.cos(self.heading), jnp.sin(self.heading)])

    def complex_amplitude(self) -> Complex[Array, " w"]:
        """Complex amplitudes a exp(i phase) (m), (w,)."""
        return self.amplitude * jnp.exp(1j * self.phase)


def components(
    amplitude: Float[Array, " w"],
    omega: Float[Array, " w"],
    environment: Environment,
    *,
    heading: Float[Array, " w"] | float = 0.0,
    phase: Float[Array, " w"] | float = 0.0,
    first: int | None = None,
) -> Components:
    """Wave components from amplitudes and frequencies, with wavenumbers by linear dispersion.

    Args:
        amplitude: Amplitudes (m), (w,).
        omega: Angular frequencies (rad/s), (w,).
        environment: Water depth and gravity.
        heading: Directions that the waves travel to (rad), for each or for all.
        phase: Phases (rad), for each or for all.
        first: Number of the first harmonic, where the frequencies are successive harmonics of a period.

    Returns:
        The components.
    """
    given = amplitude, omega, environment.depth, environment.gravity, heading, phase
    return Components(*_fields(*map(as_data, given)), first)


@quick_jit
def _fields(
    amplitude: Array, omega: Array, depth: Array, gravity: Array, heading: Array, phase: Array
) -> tuple[Array, Array, Array, Array, Array]:
    """Fields of `Components`."""
    amplitude, omega = jnp.asarray(amplitude, float), jnp.asarray(omega, float)
    ones = jnp.ones_like(omega)
    return amplitude, omega, wavenumber(omega, depth, gravity), heading * ones, phase * ones


class PlaneWaves(eqx.Module):
    """Plane waves, free or bound: surface elevation and velocity potential of each.

    With theta = omega t - k . x,

        eta = Re sum E exp(i theta),    phi = Re sum i Phi cosh |k|(z + h) / cosh |k|h exp(i theta).

    With C the ratio of hyperbolic functions above and S the same with sinh on top:

    - horizontal velocity Re k Phi C exp(i theta), vertical velocity Re i |k| Phi S exp(i theta);
    - dynamic pressure over density, -d phi/dt, Re omega Phi C exp(i theta);
    - acceleration i omega times the velocity.

    A free wave has Phi = g E / omega. In a bound wave omega, k, E and Phi are independent.

    Attributes:
        omega: Angular frequencies (rad/s), not negative, (w,).
        vector: Wavenumber vectors k (rad/m), (2, w).
        elevation: Complex elevations E (m), (w,).
        potential: Complex potentials Phi (m²/s), (w,).
    """

    omega: Float[Array, " w"]  # rad/s, not negative
    vector: Float[Array, "2 w"]  # rad/m
    elevation: Complex[Array, " w"]  # m
    potential: Complex[Array, " w"]  # m2/s

    @classmethod
    def free(cls, waves: Components, environment: Environment) -> "PlaneWaves":
        """Free first-order waves of components."""
        return cls(*_free(dataclasses.replace(waves, first=None), as_data(environment.gravity)))

    def __add__(self, other: "PlaneWaves") -> "PlaneWaves":
        """Both sets of waves together."""
        return PlaneWaves(
            jnp.concatenate([self.omega, other.omega]),
            jnp.concatenate([self.vector, other.vector], axis=1),
            jnp.concatenate([self.elevation, other.elevation]),
            jnp.concatenate([self.potential, other.potential]),
        )


@quick_jit
def _free(waves: Components, gravity: Float[Array, ""]) -> tuple[Array, ...]:
    """Fields of `PlaneWaves.free`."""
    elevation = waves.complex_amplitude()
    return waves.omega, waves.vector(), elevation, gravity * elevation / waves.omega
