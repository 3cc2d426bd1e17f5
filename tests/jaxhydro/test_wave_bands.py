"""The band of first-order waves: of records and spectra of any pace, with noise, drift and without waves."""

from types import SimpleNamespace

import numpy as np
import pytest

import jaxhydro as jh
from jaxhydro.dynamics.requested_sea import Record, RequestedSea
from jaxhydro.input_schema import validate
from jaxhydro.sweep.cases import plan_of
from jaxhydro.sweep.sweep_schema import Sweep
from jaxhydro.waves.wave_bands import CUTOFF, LOW, of_records, of_spectra, wave_energy


def sea(peak: float, samples_per_wave: float = 20.0, waves: int = 400, seed: int = 0, height: float = 1.0):
    """A Pierson-Moskowitz sea with its peak at a frequency (Hz), standard deviation `height`, and its sampling interval."""
    count = int(waves * samples_per_wave)
    step = 1 / (peak * samples_per_wave)
    f = np.fft.rfftfreq(count, step)[1:]
    density = f**-5.0 * np.exp(-1.25 * (peak / f) ** 4)
    draw = np.random.default_rng(seed).normal(size=(2, len(f)))
    x = np.fft.irfft(np.concatenate([[0], np.sqrt(density) * (draw[0] + 1j * draw[1])]), count)
    return height * x / x.std(), step


def test_the_usual_band_is_kept_where_the_waves_lie_in_it() -> None:
    assert of_records([sea(0.1)], 1.0) == of_records([sea(0.1)], 0.1) == (LOW, CUTOFF)
    assert of_records([sea(1.0)], 0.1) == (0.3, 3.0)  # that of the hull
    assert of_records([sea(0.04)], 1.0) == (LOW, CUTOFF)  # a swell of 25 s
    assert of_records([], 0.1) == (LOW, CUTOFF)


@pytest.mark.parametrize("peak", [0.02, 3.0])
def test_elsewhere_the_band_holds_the_waves(peak) -> None:
    """A flume's record of 3 Hz, a swell of 50 s: below the band and above it is 1 % of the spectrum at most."""
    low, cutoff = of_records([sea(peak)], 0.05 if peak > 1 else 1.0)
    assert 0.35 * peak < low < 0.45 * peak
    assert 2.6 * peak < cutoff < 3.8 * peak
    assert wave_energy(*sea(peak, seed=1)).within(low, cutoff) > 0.97


def test_regular_waves_have_a_band() -> None:
    time = np.arange(0.0, 60.0, 0.02)
    assert of_records([(np.sin(2 * np.pi * 5.0 * time), 0.02)], 0.1) == pytest.approx((2.5, 5.5))  # pace 0.1: to 5.5 Hz
    assert of_records([(np.sin(2 * np.pi * 4.0 * time), 0.02)], 0.05) == (0.6, 6.0)
    assert of_records([(np.sin(2 * np.pi * 8.0 * time), 0.02)], 0.05) == pytest.approx((4.0, 11.0), rel=0.01)


def test_noise_and_drift_are_no_waves() -> None:
    """The band of a sea stays with a tenth of white noise, a seiche of 200 s and a drift; a calm record has none."""
    rng = np.random.default_rng(3)
    x, step = sea(3.0)
    time = step * np.arange(len(x))
    plain = of_records([(x, step)], 0.05)
    rough = x + 0.33 * rng.normal(size=len(x)) + 0.4 * np.sin(2 * np.pi * time / 60) + 0.02 * time
    assert of_records([(rough, step)], 0.05) == pytest.approx(plain, rel=0.1)
    calm = (1e-3 * rng.normal(size=4000), 0.05)
    assert wave_energy(*calm) is None and wave_energy(np.zeros(4000), 0.05) is None
    assert wave_energy(1e-3 * time, step) is None
    assert of_records([calm, (x, step)], 0.05) == plain
    assert of_records([calm], 0.1) == (LOW, CUTOFF)


def test_two_seas_share_a_band() -> None:
    """From the slowest to the fastest: a swell with a sea on it, and one record of each."""
    swell, wind = of_records([sea(0.02)], 0.1), of_records([sea(3.0)], 0.05)
    assert of_records([sea(0.02), sea(3.0)], 0.05) == (swell[0], wind[1])
    (x, step), (y, other_step) = sea(0.2, height=0.4), sea(0.8, 20.0, 1600, height=1.0)
    y = np.interp(np.arange(len(x)) * step, np.arange(len(y)) * other_step, y)
    low, _ = of_records([(x + y, step)], 0.5)
    assert low < 0.2  # 14 % of the energy are the swell's


def test_sampling_limits_the_band() -> None:
    x, step = sea(3.0, samples_per_wave=5.0)
    low, cutoff = of_records([(x, step)], 0.05)
    assert cutoff <= 0.45 / step + 1e-9 and low < 1.5


def test_spectra_by_their_peaks() -> None:
    """The band of a peak holds 99 % of Pierson and Moskowitz' spectrum, and all but 1e-4 lies above its beginning."""
    assert of_spectra([9.0], 1.0) == of_spectra([9.0], 0.1) == (LOW, CUTOFF)
    assert of_spectra([0.9], 0.1) == (0.3, 3.0)
    low, cutoff = of_spectra([50.0], 1.0)
    share = [np.exp(-1.25 * (0.02 / f) ** 4) for f in (low, cutoff)]
    assert share[0] < 1e-4 and share[1] == pytest.approx(0.99, abs=1e-3)
    assert of_spectra([3.0, 9.0], 1.0, [0.01, 0.99]) == (LOW, CUTOFF)  # hardly any of the energy
    assert of_spectra([3.0], 1.0) == (0.134, 0.55)  # a large hull does not feel shorter waves
    assert of_spectra([0.5], 1.0) == (LOW, CUTOFF)  # none of them


def asked(**what) -> RequestedSea:
    return RequestedSea(
        **{
            "hs": 2.0,
            "tp": 9.0,
            "gamma": None,
            "spectrum": "jonswap",
            "seed": 0,
            "amplitudes": "deterministic",
            "low": None,
            "cutoff": None,
            "order": 2,
            "stretching": "vertical",
            "heading": 0.0,
            "transient": None,
            **what,
        }
    )


@pytest.mark.parametrize(("tp", "pace"), [(9.0, 1.0), (0.9, 0.1), (1.4, 0.12), (40.0, 1.0), (0.3, 0.1)])
def test_simulate_and_sweep_have_one_rule(tp, pace) -> None:
    sweep = {"platform": "p", "scatter": [{"hs": 0.01 * tp**2, "tp": tp}], "duration": 600.0}
    plan, _ = plan_of(validate(Sweep, sweep, "sweep"), "sweep", pace)
    assert (plan.low, plan.cutoff) == asked(hs=0.01 * tp**2, tp=tp).band(pace)


def test_simulate_and_calibrate_have_one_rule() -> None:
    from calibration.campaign.wave_band import wave_band

    x, step = sea(3.0)
    time = step * np.arange(len(x))
    record = SimpleNamespace(kind="irregular", use="fit", time=time, wave=x)
    manifest = SimpleNamespace(wave_band=None, scale=1.0)
    band = asked(hs=None, tp=None, record=Record("f", "c", time, x, (0.0, 0.0))).band(0.1)
    assert band == wave_band(manifest, SimpleNamespace(pace=0.1), [record]) != (LOW, CUTOFF)


def test_a_sweep_says_its_own_band() -> None:
    sweep = {"platform": "p", "scatter": [{"hs": 2.0, "tp": 9.0}], "duration": 600.0, "low": 0.04}
    plan, _ = plan_of(validate(Sweep, sweep, "sweep"), "sweep")
    assert (plan.low, plan.cutoff) == (0.04, CUTOFF)
    with pytest.raises(jh.InputError, match=r"cutoff: expected a number above low, 0\.4 Hz, found 0\.3"):
        plan_of(validate(Sweep, sweep | {"low": 0.4}, "sweep"), "sweep")
