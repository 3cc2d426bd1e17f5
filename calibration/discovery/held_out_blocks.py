"""Blocks of fitted tests left out in turn, for campaigns without held-out tests.

A block of a decay has an initial state of its own, which is fitted to it. A block of a test in waves is simulated with the
whole record and compared within the block.
"""

from collections.abc import Sequence
from dataclasses import replace

import jax.numpy as jnp
import numpy as np

from calibration.campaign.records import Record
from calibration.discovery.broyden_fit import fit
from calibration.discovery.campaign_study import highest_frequency
from calibration.discovery.expected_residuals import expected_rows
from calibration.discovery.fit_state import FitState, ResidualSummary
from calibration.discovery.linearisations import Point, Prior
from calibration.discovery.measured_series import gather_decay_series, gather_sea
from calibration.discovery.study import Study
from calibration.residuals.decays import crossing_period, first_guess

BLOCKS_PER_TEST = 3  # blocks
MIN_CYCLES_PER_BLOCK = 1.5  # cycles of a decay
BLOCK_ITERATIONS = 6  # iterations of a fit to blocks


class HeldOutBlocks:
    """A study's fitted tests in blocks of time.

    Attributes:
        study: The study of the blocks.
        block: Number of every series' block (s,).
        summaries: Results so far, by names of effects.
    """

    def __init__(self, study: Study, records: Sequence[Record]) -> None:
        self.study, self.block = study_in_blocks(study, records)
        self.summaries: dict[tuple[str, ...], ResidualSummary] = {}

    def residual_summary(self, state: FitState, prior: Prior) -> ResidualSummary:
        """Residual of every block where the others are fitted, beginning at a state."""
        names = tuple(candidate.name for candidate in state.chosen)
        if names not in self.summaries:
            self.summaries[names] = self._residual_summary(state, prior)
        return self.summaries[names]

    def _residual_summary(self, state: FitState, prior: Prior) -> ResidualSummary:
        study = self.study
        releases = np.zeros((0, 0))
        if study.decays is not None:
            releases = np.asarray(first_guess(study.decay_records, study.decays.data))
        point = Point(state.linearisation.point.x, releases)
        every = np.ones(len(study.series), bool)
        if study.decays is not None:
            point = fit(
                study, study.linearise(point, ()), every, prior, iterations=BLOCK_ITERATIONS, relinearisations=1
            ).linearisation.point
        if study.seas and study.expected is None:
            self.study = study = replace(study, expected=expected_rows(study, point))
        linearisation = study.linearise(point, state.linearisation.active)
        summary = ResidualSummary.of(study, linearisation.residual)
        for number in range(BLOCKS_PER_TEST):
            out = self.block == number
            fitted = fit(study, linearisation, ~out, prior, iterations=BLOCK_ITERATIONS).linearisation
            if study.decays is not None:
                fitted = fit(study, fitted.restricted_to(()), out, prior, iterations=BLOCK_ITERATIONS).linearisation
            held_out = ResidualSummary.of(study, study.residual(fitted.point))
            summary = ResidualSummary(
                *(np.where(out if new.ndim == 1 else out[:, None], new, old) for new, old in zip(held_out, summary))
            )
        return summary


def study_in_blocks(study: Study, records: Sequence[Record]) -> tuple[Study, np.ndarray]:
    """A study's fitted tests cut into blocks of time, `BLOCKS_PER_TEST` of each.

    Decays that are too short are left out.

    Returns:
        The study of the blocks, and the number of every series' block (s,).

    Raises:
        ValueError: If nothing can be cut.
    """
    by_id = {record.id: record for record in records}
    highest = highest_frequency(study.model)
    cut = [
        part
        for record in study.decay_records
        if record.use == "fit"
        and record.time[-1] - record.time[0] > BLOCKS_PER_TEST * MIN_CYCLES_PER_BLOCK * crossing_period(record)
        for part in split_record(record)
    ]
    series, cuts, seas, numbers = [], [], [], []
    decays, own_width = None, np.zeros((0, 0))
    if cut:
        assert study.decays is not None
        step = float(np.asarray(study.decays.data.step).max())
        decays, new_series, own_width, rows = gather_decay_series(
            cut, study.model, study.space, study.decays.from_rest, step, highest
        )
        series += new_series
        cuts.append(rows)
        numbers += [i % BLOCKS_PER_TEST for i in range(len(cut)) for _ in decays.data.dofs]
    for sea in study.seas:
        fitted = [i for i, test in enumerate(sea.tests) if by_id[test].use == "fit"]
        n = sea.measured.shape[-1] // BLOCKS_PER_TEST
        if not fitted:
            continue
        places = [(i, k) for i in fitted for k in range(BLOCKS_PER_TEST)]
        sea_blocks = replace(
            sea,
            measured=jnp.stack([sea.measured[i, :, k * n : (k + 1) * n] for i, k in places]),
            begins=tuple(sea.begins[i] + k * n for i, k in places),
            tests=tuple(f"{sea.tests[i]}, block {k + 1}" for i, k in places),
        )
        tests = [replace(by_id[sea.tests[i]], id=name) for (i, _), name in zip(places, sea_blocks.tests)]
        new_series, rows = gather_sea(sea_blocks, tests, highest)
        series += new_series
        cuts.append(rows)
        seas.append(sea_blocks)
        numbers += [k for _, k in places for _ in sea.dofs]
    if not series:
        raise ValueError("no test is long enough to be cut into blocks")
    return replace(
        study,
        decays=decays,
        seas=tuple(seas),
        series=tuple(series),
        decay_records=tuple(cut),
        own_width=own_width,
        cuts=tuple(cuts),
        expected=None,
        baseline=None,
    ), np.array(numbers)


def split_record(record: Record) -> list[Record]:
    """A record cut into `BLOCKS_PER_TEST` consecutive blocks."""
    cuts = np.array_split(np.arange(len(record.time)), BLOCKS_PER_TEST)
    return [
        replace(
            record,
            id=f"{record.id}, block {k + 1}",
            time=record.time[samples],
            values={name: values[samples] for name, values in record.values.items()},
        )
        for k, samples in enumerate(cuts)
    ]
