"""Load elements of a group of members: what a lumped strip is, and how motions come nearer with more."""

import jax.numpy as jnp
import numpy as np
import pytest
from numpy.testing import assert_allclose

from jaxhydro import IrregularSea, build, convergence, jonswap, load_platform, natural_modes, simulate, spectrum_components
from jaxhydro.analysis.motion_bands import bands
from jaxhydro.analysis.spectral import band_integral, power_spectrum
from jaxhydro.platform.convergence import with_elements

PLATFORM = load_platform("volturnus-s-focal")
TIMES = np.arange(0.0, 480.0, 0.5)


@pytest.fixture(scope="module")
def sea() -> IrregularSea:
    water = build(PLATFORM).environment
    waves = spectrum_components(lambda w: jonswap(w, 3.1, 8.96), 480.0, water, low=0.05, cutoff=0.2, seed=3)
    return IrregularSea(waves, water)


@pytest.fixture(scope="module")
def study(sea: IrregularSea):
    return convergence(PLATFORM, sea, TIMES, peak_period=8.96, elements=(4, 1, 2), points=1, transient=120.0)


def test_a_lumped_strip_is_at_the_middle() -> None:
    """Midpoint rule: three pontoons of 40.5 m from r = 5 m, one strip each; columns stay as they are."""
    before, after = (build(p).hull for p in (PLATFORM, with_elements(PLATFORM, "pontoon", 1, points=1)))
    lumped = [i for i, e in enumerate(after.strips.element) if float(after.elements.thickness[e]) > 0]
    assert len(lumped) == 3
    of = np.array(after.strips.element)[lumped]
    along = after.strips.fraction[np.array(lumped)] * after.elements.length[of]
    middle = after.strips.start[:, lumped] + along * after.strips.axis[:, lumped]
    assert_allclose(jnp.hypot(middle[0], middle[1]), 25.25, rtol=1e-12)
    assert_allclose(after.strips.weight[np.array(lumped)], 1.0, rtol=1e-15)
    count = [sum(float(h.elements.thickness[e]) == 0 for e in h.strips.element) for h in (before, after)]
    assert count[0] == count[1] == 4 * 8


@pytest.mark.slow
def test_periods_by_elements(study) -> None:
    """Heave's added mass is the sum whatever the lumps; of pitch's n lumps miss L^2 / (12 n^2): errors of T^2 fall by 4."""
    assert study.elements == (4, 1, 2)
    assert_allclose(study.period["heave"], study.period["heave"][0], rtol=1e-10)
    whole = natural_modes(build(PLATFORM)).of("pitch")
    four, single, two = study.period["pitch"] ** 2 - whole**2
    assert single < two < four < 0
    assert (single / two, two / four) == pytest.approx((4, 4), rel=0.03)


@pytest.mark.slow
def test_motions_by_elements(study) -> None:
    """Against the finest: none for itself, less for two than for one; changes of integrals follow."""
    for dof in ("surge", "heave", "pitch"):
        four, single, two = study.difference[dof]
        assert four == 0 < two < single
    heave = study.change("heave", "wave_frequency")
    assert heave[0] == 0 < heave[2] < heave[1] < 0.2
    assert_allclose(study.integral["heave"]["wave_frequency"][1], (1 + heave[1]) * study.integral["heave"]["wave_frequency"][0])


@pytest.mark.slow
def test_the_same_in_a_cut_platform(sea: IrregularSea, study) -> None:
    """One row is the simulation of the platform with that many elements."""
    motion = np.asarray(simulate(build(with_elements(PLATFORM, "pontoon", 2, points=1)), TIMES, sea)["heave"])
    late = TIMES >= 120.0
    spectrum = power_spectrum(TIMES[late], motion[late])
    expected = band_integral(spectrum, *bands("heave", 8.96)["low_frequency"])
    assert study.integral["heave"]["low_frequency"][2] == pytest.approx(expected, rel=1e-12)


@pytest.mark.parametrize(
    "options, message",
    [
        ({"group": "pontoons"}, r"no group of members 'pontoons'; there are: column, pontoon. Did you mean 'pontoon'"),
        ({"elements": (1, 0)}, r"at least 1, found \(1, 0\)"),
        ({"elements": ()}, r"found \(\)"),
    ],
)
def test_what_cannot_be(sea: IrregularSea, options, message: str) -> None:
    with pytest.raises(ValueError, match=message):
        convergence(PLATFORM, sea, TIMES, peak_period=8.96, **options)
