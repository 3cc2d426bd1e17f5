"""A campaign's records and a model with every candidate at its null: evaluated, fitted and weighed along any few parameters."""

from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from typing import Literal

import jax.numpy as jnp
import numpy as np

from calibration.campaign import Campaign
from calibration.discovery.bands import bands_of
from calibration.discovery.evidence import (
    Decays,
    Frame,
    SeaRecord,
    decay_products,
    sea_products,
)
from calibration.parameters import ParameterSpace
from calibration.records import Record
from calibration.residuals import Problem, dominant_period, first_guess, gather
from calibration.runs import KINDS
from calibration.seas import Options, sea_step, seas_of
from calibration.stretches import window
from calibration.transforms import LogInterval
from jaxhydro.environment import DOFS
from jaxhydro.integrate import clock
from jaxhydro.model import Model
from jaxhydro.statics import equilibrium, natural_modes
from jaxhydro.waves.irregular import fourier_length
from jaxhydro.waves.irregular_sea import EXCURSION

Seen = Literal["all", "fit", "none"]
STEPS_PER_PERIOD = 16
BANDS = 14
EXCURSIONS = 1.5  # of EXCURSION: how far a sea is prepared for
OFFSET = 0.02  # of a decay's spread: what a sensor's zero may differ by between records, beside its noise


@dataclass(frozen=True)
class Series:
    """One motion of one test: what the residual of it is compared with. `dof` (b,) are degrees of freedom by band, `samples`
    how many there are."""

    test: str
    kind: str
    use: str
    channel: str
    noise: float
    spread: float
    dof: np.ndarray
    low: np.ndarray
    high: np.ndarray
    samples: int


@dataclass(frozen=True)
class Place:
    """Where a fit is: coordinates of all parameters, and every decay's own unknowns."""

    x: np.ndarray
    own: np.ndarray


@dataclass(frozen=True)
class Look:
    """Products at a place along some parameters: by series and band, columns first the `active` parameters, last the residual;
    of decays the record's own unknowns in between."""

    place: Place
    active: tuple[int, ...]
    decays: np.ndarray  # (r, c, b, k, k)
    seas: tuple[np.ndarray, ...]  # by run (w, c, b, q+1, q+1)

    def power(self) -> np.ndarray:
        """Sum of squares by series and band, in the order of `Study.series`."""
        parts = [self.decays[..., -1, -1].reshape(-1, self.decays.shape[2])] if self.decays.size else []
        parts += [one[..., -1, -1].reshape(-1, one.shape[2]) for one in self.seas]
        return np.concatenate(parts)


@dataclass(frozen=True)
class Prior:
    """Gaussian priors of the steps along directions from where the study starts: mean and standard deviation by direction."""

    mean: np.ndarray
    width: np.ndarray


@dataclass
class Study:
    """All records of a campaign that take part, against one model. Directions (d, p), orthogonal, are what is free: most are
    one parameter each, some move several together."""

    model: Model
    space: ParameterSpace
    names: tuple[str, ...]
    directions: np.ndarray
    decays: Decays | None
    seas: tuple[SeaRecord, ...]
    series: tuple[Series, ...]
    records: tuple[Record, ...]
    width: int
    own_width: np.ndarray
    report: Callable[[str], None] = field(default=lambda _: None)
    evaluations: int = 0

    @property
    def labels(self) -> tuple[str, ...]:
        return self.space.labels

    @property
    def logarithmic(self) -> np.ndarray:
        """Which directions are logarithms: long steps along them mean nothing."""
        flags = np.array([isinstance(free.transform, LogInterval) for free in self.space.free])
        return (np.abs(self.directions) * flags).sum(axis=1) > 0

    def index(self, names: Sequence[str]) -> list[int]:
        """Numbers of directions."""
        return [self.names.index(name) for name in names]

    def steps(self, x: np.ndarray) -> np.ndarray:
        """How far coordinates are from where the study starts, along every direction."""
        return self.directions @ (x - np.asarray(self.space.start)) / (self.directions**2).sum(axis=1)

    def look(self, place: Place, active: Sequence[int], until: np.ndarray | None = None, seas: Seen = "all") -> Look:
        """Products along the active directions, decays up to `until` (s). Of tests in waves that are not to be seen: zeros."""
        if len(active) > self.width:
            raise ValueError(f"at most {self.width} parameters at a time, found {len(active)}")
        self.evaluations += 1
        basis = np.zeros((len(place.x), self.width))
        basis[:, : len(active)] = self.directions[list(active)].T
        frame = Frame(jnp.asarray(place.x), jnp.asarray(basis))
        q = len(active)

        def of_decays() -> np.ndarray:
            if self.decays is None:
                return np.zeros(0)
            ends = np.array([record.time[-1] for record in self.decay_records]) if until is None else until
            found = np.asarray(decay_products(self.decays, frame, jnp.asarray(place.own), jnp.asarray(ends)))
            kept = np.r_[:q, self.width : found.shape[-1]]
            return found[..., kept[:, None], kept]

        def of_sea(record: SeaRecord) -> np.ndarray:
            kept = np.r_[:q, self.width]
            return np.asarray(sea_products(record, frame)[0])[..., kept[:, None], kept]

        uses = {one.test: one.use for one in self.series}

        def seen(record: SeaRecord) -> bool:
            return seas == "all" or (seas == "fit" and any(uses[test] == "fit" for test in record.tests))

        with ThreadPoolExecutor(2) as pool:  # XLA runs a loop on one core
            waiting = [pool.submit(of_sea, record) if seen(record) else None for record in self.seas]
            decays = of_decays()
            shape = (q + 1, q + 1)
            found = (
                np.zeros((*record.measured.shape[:2], record.member.shape[1], *shape)) if one is None else one.result()
                for record, one in zip(self.seas, waiting)
            )
            return Look(place, tuple(active), decays, tuple(found))

    @property
    def decay_records(self) -> tuple[Record, ...]:
        return tuple(record for record in self.records if record.kind == "decay")

    def start(self) -> Place:
        """Where the declared model is, releases as read off the records."""
        own = np.zeros((0, 0))
        if self.decays is not None:
            own = np.asarray(first_guess(self.decay_records, self.decays.problem.data))
        return Place(np.asarray(self.space.start), own)

    def mean_squares(self, look: Look, share: np.ndarray | None = None) -> tuple[np.ndarray, np.ndarray]:
        """Mean square over the noise's, and degrees of freedom, by series and band (s, b)."""
        dof = np.stack([one.dof for one in self.series]) * (1.0 if share is None else share[:, None])
        noise = np.array([one.noise for one in self.series])[:, None]
        power = look.power()
        return np.where(dof > 0, power / np.where(dof > 0, dof, 1.0) / noise**2, 0.0), dof


def study_of(
    model: Model,
    space: ParameterSpace,
    names: Sequence[str],
    directions: np.ndarray,
    campaign: Campaign,
    options: Options,
    width: int,
    kinds: Sequence[str] = ("decays", "waves"),
) -> Study:
    """The records of a campaign, against a model with every candidate at its null. Raises InputError."""
    records = [r for r in campaign.records if r.use in ("fit", "holdout")]
    decaying = [r for r in records if r.kind == "decay" and "decays" in kinds]
    waving = [r for r in records if r.kind in KINDS and "waves" in kinds]
    from_rest = campaign.manifest.zero is not None
    periods = natural_modes(model).period
    highest = 6.0 / float(periods.min()) if len(periods) else 1.0
    series: list[Series] = []
    decays, own_width = None, np.zeros((0, 0))
    if decaying:
        step = min([float(periods.min()) / STEPS_PER_PERIOD, *(dominant_period(r) / STEPS_PER_PERIOD for r in decaying)])
        data = gather(decaying, model, step)
        rest = None if from_rest else equilibrium(model)
        problem = Problem(model, data, space, from_rest, rest)
        steps = [float(np.median(np.diff(r.time))) for r in decaying]
        length = data.time.shape[1]
        cut = [bands_of(len(r.time) * dt, dt, length, BANDS, highest) for r, dt in zip(decaying, steps)]
        lines = max(one.member.shape[1] for one in cut)
        member = np.stack([np.pad(one.member, ((0, 0), (0, lines - one.member.shape[1]))) for one in cut])
        decays = Decays(problem, jnp.asarray(member))
        own_width = np.full((len(decaying), 3, len(data.dofs)), np.inf)
        for i, (record, one) in enumerate(zip(decaying, cut)):
            for j, dof in enumerate(data.dofs):
                there = record.values.get(DOFS[dof])
                noise = record.noise.get(DOFS[dof], 1.0)
                spread = 1.0 if there is None else float(np.std(there))
                counted = 2 * one.lines if there is not None else 0 * one.lines
                series.append(
                    Series(
                        record.id, "decay", record.use, DOFS[dof], noise, spread, counted, one.low, one.high, len(record.time)
                    )
                )
                own_width[i, 2, j] = (OFFSET * spread + 3 * noise / np.sqrt(len(record.time))) / float(data.unit[i, j])
        own_width = own_width.reshape(len(decaying), -1)
    seas = []
    if waving:
        step = sea_step(model, options)
        for run, made in seas_of(campaign, model.environment, options):
            tests = [r for r in run.records if r in waving or any(r.id == w.id for w in waving)]
            if not tests:
                continue
            last = max(int(run.samples(r)[-1]) for r in tests)
            times = run.time[: last + 1]
            period = float(made.sea.components.period)
            dt = period / fourier_length(period / step)
            count = int(np.ceil((times[-1] - times[0]) / dt - 1e-9))
            sea = made.sea.prepared(
                model.hull.extremities(), model.cylinders, clock("ab4", float(times[0]), dt, count), EXCURSIONS * EXCURSION
            )
            channels = [dof for dof in DOFS if all(dof in r.values for r in tests)]
            windows = [window(run, r) for r in tests]
            n = min(len(w) for w in windows)
            measured = np.stack(
                [[np.interp(w[:n], run.samples(r), r.values[c]) for c in channels] for r, w in zip(tests, windows)]
            )
            cut = [bands_of(n * run.step, run.step, n, BANDS, highest) for _ in tests]
            for r, one, values in zip(tests, cut, measured):
                for c, v in zip(channels, values):
                    series.append(
                        Series(r.id, r.kind, r.use, c, r.noise[c], float(np.std(v)), 2 * one.lines, one.low, one.high, n)
                    )
            seas.append(
                SeaRecord(
                    model,
                    sea,
                    jnp.asarray(times),
                    jnp.asarray(dt),
                    jnp.asarray(measured),
                    jnp.asarray(np.stack([one.member for one in cut])),
                    None,
                    space,
                    from_rest,
                    count,
                    tuple(int(w[0]) for w in windows),
                    tuple(DOFS.index(c) for c in channels),
                    tuple(r.id for r in tests),
                )
            )
    every = tuple([*decaying, *waving])
    return Study(model, space, tuple(names), directions, decays, tuple(seas), tuple(series), every, width, own_width)
