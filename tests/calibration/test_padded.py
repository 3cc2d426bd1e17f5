"""Records of nearly the same length share compiled programs, and padding changes no result."""

from dataclasses import replace

import equinox as eqx
import numpy as np
import pytest

from calibration import load_campaign
from calibration.campaign.load_campaign import Campaign
from calibration.discovery.held_out_blocks import study_in_blocks
from calibration.discovery.linearisations import Point
from calibration.discovery.residual_slopes import decay_residual
from calibration.discovery.study_set_up import set_up_study
from calibration.fitting.decay_fit import prepare_fit
from calibration.residuals.decays import DecayProblem, first_guess
from calibration.residuals.padded_sizes import padded_size
from calibration.residuals.wave_options import Options

DECAYS = "jaxhydro/campaigns/volturnus-s-decays"


def test_sizes_are_a_ladder() -> None:
    """No less than what is to be held, no more than 1.25 times, and four to an octave."""
    sizes = [padded_size(n) for n in range(1, 5000)]
    assert all(n <= size <= max(1.25 * n, n + 1) for n, size in enumerate(sizes, 1))
    assert len({size for size in sizes if 1024 < size <= 2048}) == 4
    assert sizes == sorted(sizes) and all(padded_size(size) == size for size in sizes)


def cut(campaign: Campaign, share: float, ids: tuple[str, ...]) -> Campaign:
    """The campaign with some of its records only, each cut to a share of its length."""

    def one(record):
        n = int(share * len(record.time))
        return replace(record, time=record.time[:n], values={name: values[:n] for name, values in record.values.items()})

    return replace(campaign, records=tuple(one(record) for record in campaign.records if record.id in ids))


@pytest.fixture(scope="module")
def campaign() -> Campaign:
    return load_campaign(DECAYS)


@pytest.mark.slow
def test_records_of_nearly_the_same_length_are_traced_once(campaign, monkeypatch) -> None:
    traces = []
    motion = DecayProblem.motion

    def counted(self, *args):
        traces.append((self.data.time.shape, self.data.capacity))
        return motion(self, *args)

    monkeypatch.setattr(DecayProblem, "motion", counted)
    ids = tuple(record.id for record in campaign.records if record.degree_of_freedom == "heave")[:1]
    whole = len(campaign.record(ids[0]).time)
    shares = [n / whole for n in (560, 570, 580)]
    counts = []
    for share in shares:
        fit = prepare_fit(cut(campaign, share, ids))
        eqx.filter_jit(DecayProblem.products)(fit.decays.problem, fit.unknowns).block_until_ready()
        counts.append(len(traces))
    assert counts[0] > 0 and counts[1:] == counts[:1] * 2, traces


@pytest.mark.slow
def test_padding_changes_no_result(campaign, monkeypatch) -> None:
    """The products of residuals and slopes, against those of arrays just as long as the record."""
    ids = (next(record.id for record in campaign.records if record.degree_of_freedom == "heave"),)

    def products():
        fit = prepare_fit(cut(campaign, 0.37, ids))
        return fit.decays.problem.data, fit.decays.problem.products(fit.unknowns)

    padded, unpadded = products()
    monkeypatch.setattr("calibration.residuals.decays.padded_size", lambda count: count)
    exact, expected = products()
    assert padded.time.shape[1] > exact.time.shape[1] and padded.capacity > exact.capacity
    scale = np.sqrt(np.einsum("rckk->rck", expected))
    limit = 1e-12 * scale[..., :, None] * scale[..., None, :] + 1e-300
    assert (np.abs(unpadded - expected) <= limit).all()


@pytest.mark.slow
def test_blocks_of_decays_take_the_programs_of_whole_decays(campaign) -> None:
    """Padded to their size, which changes no result."""
    ids = (next(record.id for record in campaign.records if record.degree_of_freedom == "heave"),)
    study = set_up_study(cut(campaign, 0.37, ids), Options(), ()).study
    blocks, _ = study_in_blocks(study, campaign.records)
    assert len(blocks.decay_records) > len(study.decay_records) == 1
    compiled = []
    for variant in (study, blocks):
        own = first_guess(variant.decay_records, variant.decays.data)
        (motions,) = variant.motions(Point(np.asarray(variant.space.start), np.asarray(own)))
        expected = variant.decays.residual(variant.space.start, own[0], variant.simulations.decays.padded_data[0])
        channels, samples = len(variant.decays.data.dofs), variant.decays.data.time.shape[1]
        np.testing.assert_allclose(motions[:channels], expected[:, :samples], atol=1e-12)
        assert not np.any(expected[:, samples:])
        compiled.append(len(decay_residual._compiled))
    assert compiled[0] == compiled[1]
