"""Makes the built-in campaign volturnus-s-decays: nine free decays of the reference model with the paper's Table 1.

    python benchmarks/make_demo_campaign.py [--seed 1] [--out DIR]

Surge, heave and pitch are each released from three amplitudes; the releases are imperfect (a small initial velocity,
a little of the other in-plane motions) and the sensors have white noise. The platform file declares other starting
values than the data were made with, as a user's would. Another seed is other noise on the same motions; another
release seed, other releases. The clean motions are made once per process.
"""

import argparse
import sys
from functools import cache
from pathlib import Path
from time import perf_counter

import numpy as np
from ruamel.yaml import YAML

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
from benchmarks.reference_model import ReferenceModel

ROOT = Path(__file__).resolve().parents[1]
FOLDER = ROOT / "jaxhydro" / "campaigns" / "volturnus-s-decays"
SAMPLING = 0.2  # s
RELEASE_SEED = 0  # of the campaign that is shipped
CHANNELS = ("surge", "heave", "pitch")
IN_PLANE = [0, 2, 4]
AMPLITUDES = {"surge": (3.0, 6.0, 10.0), "heave": (1.0, 2.0, 3.5), "pitch": (2.0, 4.0, 6.5)}  # m, m, deg
DURATIONS = {"surge": 800.0, "heave": 240.0, "pitch": 330.0}  # s
PERIODS = {"surge": 134.0, "heave": 20.0, "pitch": 27.0}  # s, only to size the releases' velocities
NOISE = {"surge": 0.01, "heave": 0.005, "pitch": 0.01}  # m, m, deg

TRUE_COEFFICIENTS = {
    "column": {"Ca_t": 1.50, "Ca_z": 0.12, "Cd_t": 2.09, "Cd_z": 2.23},
    "pontoon": {"Ca_t": 0.11, "Ca_z": 1.87, "Cd_t": 1.84, "Cd_z": 4.96},
}
TRUE_DAMPING = {"B11": 4.4e4, "B33": 1.6e5, "B55": 3.63e8}

# columns 20 m deep and 40.5 m of three pontoons; the hull floats upright by its weight alone
MASS = round(1025.0 * (20.0 * np.pi / 4 * (10.0**2 + 3 * 12.5**2) + 3 * 40.5 * 12.5 * 7.0))

PLATFORM = f"""\
# VolturnUS-S, the hull of the IEA 15 MW turbine, on three horizontal springs as in a wave basin. Full scale.
name: VolturnUS-S
water: {{density: 1025.0, depth: 200.0}}
rigid_body:
  mass: {MASS:.1f}
  centre_of_mass: [0.0, 0.0, -2.4]
  inertia: {{Ixx: 4.42e10, Iyy: 4.42e10, Izz: 2.40e10}}
members:
  - {{name: centre_column, group: column, shape: circ, d: 10.0, rA: [0, 0, -20], rB: [0, 0, 15]}}
  - name: outer_column
    group: column
    shape: circ
    d: 12.5
    rA: [51.75, 0, -20]
    rB: [51.75, 0, 15]
    heading: [60, 180, 300]
  - name: pontoon
    group: pontoon
    shape: rect
    d: [12.5, 7.0]
    rA: [5.0, 0, -16.5]
    rB: [45.5, 0, -16.5]
    heading: [60, 180, 300]
coefficients:                  # starting values: a calibration has to find better ones
  column:  {{Ca_t: 1.0, Ca_z: 0.5, Cd_t: 1.0, Cd_z: 2.0}}
  pontoon: {{Ca_t: 0.5, Ca_z: 1.5, Cd_t: 1.5, Cd_z: 3.0}}
linear_damping: {{B11: 5.0e4, B33: 2.0e5, B55: 3.0e8}}
mooring:
  kind: linear_springs
  lines:
    - {{anchor: [150.0, 259.808, -14.0], fairlead: [29.0, 50.229, -14.0], stiffness: 45000.0, pretension: 1500000.0}}
    - {{anchor: [-300.0, 0.0, -14.0], fairlead: [-58.0, 0.0, -14.0], stiffness: 45000.0, pretension: 1500000.0}}
    - {{anchor: [150.0, -259.808, -14.0], fairlead: [29.0, -50.229, -14.0], stiffness: 45000.0, pretension: 1500000.0}}
"""

CAMPAIGN = """\
# Nine free decays made by benchmarks/make_demo_campaign.py (seed {seed}): nothing is missing from the declared
# model but good coefficients.
name: volturnus-s-decays
platform: platform.yaml
scale: 1.0
channels:
  time:  {{column: time_s, unit: s}}
  surge: {{column: surge_m, unit: m}}
  heave: {{column: heave_m, unit: m}}
  pitch: {{column: pitch_deg, unit: deg}}
noise: {{surge: {NOISE[surge]}, heave: {NOISE[heave]}, pitch: {NOISE[pitch]}}}
tests:
"""


def true_model() -> ReferenceModel:
    """The platform with the coefficients that the data are made with."""
    platform = YAML(typ="safe").load(PLATFORM)
    true = platform | {"coefficients": TRUE_COEFFICIENTS, "linear_damping": TRUE_DAMPING}
    return ReferenceModel(true, strip=0.25, pontoon_strip=0.5)  # errors well below what the records resolve


def release(name: str, index: int, release_seed: int):
    """Offset and velocity (6,) (m, rad, per second) at the start of record `index` of degree of freedom `name`.

    One standard deviation is 1 % of the released amplitude and 2 % of its velocity amplitude; 1.5 % and 0.5 % of those
    of the like-numbered record in the other two motions.
    """
    random = np.random.default_rng([release_seed, CHANNELS.index(name), index])
    offset, velocity = np.zeros(6), np.zeros(6)
    for channel, column in zip(CHANNELS, IN_PLANE):
        amplitude = AMPLITUDES[channel][index] * (np.pi / 180 if channel == "pitch" else 1.0)
        main, normal = channel == name, random.standard_normal(2)
        offset[column] = amplitude * (main + (0.01 if main else 0.015) * normal[0])
        velocity[column] = amplitude * 2 * np.pi / PERIODS[channel] * (0.02 if main else 0.005) * normal[1]
    return offset, velocity


@cache
def clean_motion(name: str, index: int, release_seed: int):
    """Time (n,) in s, and noise-free surge, heave, pitch (n, 3) in m, m, deg from the equilibrium; read only.

    At this tolerance the error is below 1e-5 m and deg (see tests/benchmarks/test_reference_model.py), far below the noise.
    """
    model = true_model()
    t, q = model.decay(*release(name, index, release_seed), DURATIONS[name], SAMPLING, tolerance=1e-8)
    motion = (q - model.equilibrium())[:, IN_PLANE] * [1.0, 1.0, 180 / np.pi]
    motion.setflags(write=False)  # all callers share it
    return t, motion


def make_campaign(folder, seed: int = 1, release_seed: int = RELEASE_SEED) -> list[Path]:
    """Writes the campaign into `folder` (made if absent); gives the files' paths."""
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    random = np.random.default_rng(seed)
    manifest, written = CAMPAIGN.format(seed=seed, NOISE=NOISE), []
    for name in CHANNELS:
        for index in range(3):
            t, motion = clean_motion(name, index, release_seed)
            measured = motion + random.standard_normal(motion.shape) * [NOISE[channel] for channel in CHANNELS]
            path = folder / f"{name}-{index + 1}.csv"
            np.savetxt(
                path,
                np.column_stack([t, measured]),
                fmt="%.5f",
                delimiter=",",
                comments="",
                header="time_s,surge_m,heave_m,pitch_deg",
            )
            manifest += f"  - {{id: {path.stem}, kind: decay, degree_of_freedom: {name}, file: {path.name}, "
            manifest += "use: fit}\n"
            written.append(path)
    for path, text in ((folder / "campaign.yaml", manifest), (folder / "platform.yaml", PLATFORM)):
        path.write_text(text)
        written.append(path)
    return written


def cycles(t, x):
    """Amplitude at each cycle's start, and period (s) and damping ratio from crest to crest, of a clean decay."""
    peaks = np.flatnonzero((x[1:-1] > x[:-2]) & (x[1:-1] >= x[2:]) & (x[1:-1] > 0.005 * x[0])) + 1
    before, at, after = x[peaks - 1], x[peaks], x[peaks + 1]  # a parabola through three samples
    times = t[peaks] + 0.5 * (t[1] - t[0]) * (before - after) / (before - 2 * at + after)
    if x[1] < x[0]:  # released with no outward velocity: a crest
        times, at = np.append(t[0], times), np.append(x[0], at)
    logarithmic = np.log(at[:-1] / at[1:])
    return at[:-1], np.diff(times), logarithmic / np.hypot(2 * np.pi, logarithmic)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--seed", type=int, default=1, help="of the sensor noise (default 1)")
    parser.add_argument("--out", type=Path, default=FOLDER, help="folder to write (default: the package's own)")
    arguments = parser.parse_args()
    start = perf_counter()
    written = make_campaign(arguments.out, arguments.seed)
    print(
        f"{arguments.out}: {len(written)} files, {sum(path.stat().st_size for path in written) / 1e3:.0f} kB, "
        f"in {perf_counter() - start:.1f} s"
    )
    print("record    first cycle: amplitude, period s, damping ratio      last counted cycle")
    for column, name in enumerate(CHANNELS):
        for index in range(3):
            t, motion = clean_motion(name, index, RELEASE_SEED)
            table = np.column_stack(cycles(t, motion[:, column]))
            first, last = ("{:6.2f} {:7.2f} {:6.3f}".format(*row) for row in (table[0], table[-1]))
            print(f"{name}-{index + 1}   {first}   {last}   ({len(table)} cycles)")


if __name__ == "__main__":
    main()
