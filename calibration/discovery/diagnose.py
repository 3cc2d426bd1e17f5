"""Diagnosis of a campaign: which effects its model lacks."""

import math
import time as clock
import warnings
from collections.abc import Callable, Sequence
from pathlib import Path

from calibration.campaign.grouped_findings import group_findings
from calibration.campaign.load_campaign import Campaign
from calibration.discovery.baseline_fit import fit_baseline
from calibration.discovery.channel_signs import reversal_note, reversed_channels, with_signs_reversed
from calibration.discovery.checkpoint import load_checkpoint, save_checkpoint
from calibration.discovery.diagnosis import Diagnosis
from calibration.discovery.diagnosis_conclusion import conclude, unexplained_motions
from calibration.discovery.doubts import abandoned_decays, worsened_motions
from calibration.discovery.effects.candidates import Candidate
from calibration.discovery.fit_state import FitState
from calibration.discovery.mass_properties_check import with_mass_properties
from calibration.discovery.residual_anatomy import anatomy
from calibration.discovery.search import Search
from calibration.discovery.selection.joint_search import JointSearch
from calibration.discovery.selection.verification import Verification
from calibration.discovery.study_set_up import set_up_study
from calibration.fitting.progress import Progress
from calibration.residuals.measured_seas import NO_ZERO
from calibration.residuals.wave_options import Options, options_of
from jaxhydro.dynamics.model import Model
from jaxhydro.errors import CheckpointWarning, WaveOrderWarning
from jaxhydro.interrupts import stopping

UNKNOWN_ZERO_NOTE = f"{NO_ZERO}, so that a sensor's zero elsewhere is taken for ballast, or for a force"


def diagnose(
    model: Model,
    campaign: Campaign,
    *,
    candidates: Sequence[Candidate] = (),
    progress: Callable[[Progress], None] | None = None,
    options: Options | None = None,
    checkpoint: Path | None = None,
) -> Diagnosis:
    """Find the effects that a model lacks to explain a campaign.

    All candidate effects are selected together on a linearised model (`calibration.discovery.selection`). Every selected effect
    is verified by simulation, in the fitted tests and in those marked `holdout`.

    Args:
        model: The model to diagnose; the campaign's own is `campaign.model`.
        campaign: The campaign.
        candidates: The user's own candidate effects, beside the catalogue.
        progress: Called with the stage of the search.
        options: How seas are reconstructed; by default as the campaign states.
        checkpoint: Checkpoint file. An existing one of the same campaign, options, program and libraries is resumed.

    Returns:
        The baseline fit, the effects found with their evidence, and the augmented model.

    Raises:
        InputError: If the campaign has nothing to diagnose.
        KeyboardInterrupt: If stopped; its attribute `partial` is the diagnosis so far.

    Warns:
        CheckpointWarning: If a checkpoint file is damaged or of another run; the search then starts anew.
        WaveOrderWarning: If the wave records lack the second-order waves of theory, and the campaign does not state `records`.
    """
    begun, campaign = clock.monotonic(), campaign.with_model(model)

    def say(stage: str, fraction: float, iteration: int = 0, cost: float = math.nan) -> None:
        if progress is not None:
            progress(Progress(stage, iteration, cost, fraction, "-2 ln L"))

    states: list[FitState] = []
    unusable: list[str] = []  # why an earlier run's checkpoint is not resumed

    def spent() -> float:
        return search.record.earlier + clock.monotonic() - begun

    def reach(state: FitState) -> None:
        states.append(state)
        if checkpoint is not None:
            save_checkpoint(checkpoint, search, states, spent())

    say("reading the records", 0.0)

    def begun_with(campaign: Campaign) -> Search:
        how = options_of(campaign) if options is None else options
        search = Search.of(campaign, set_up_study(campaign, how, candidates), say)
        states.extend([] if checkpoint is None else load_checkpoint(checkpoint, search, unusable.append))
        return search

    search = begun_with(campaign)
    if search.fits.study.order_hint:  # before minutes are spent on it
        warnings.warn(search.fits.study.order_hint, WaveOrderWarning, stacklevel=2)
    wrong = {} if states else reversed_channels(campaign, search.fits)
    if wrong:
        search = begun_with(campaign := with_signs_reversed(campaign, list(wrong)))
    if states:
        say(f"going on from what was reached before: round {len(states)}", 0.2)
    else:
        if unusable:
            warnings.warn(unusable[-1], CheckpointWarning, stacklevel=2)
        reach(fit_baseline(search))

    def concluded() -> Diagnosis:
        signs = [reversal_note(list(wrong))] if wrong else []
        lost = (
            [] if search.record.alone is None else abandoned_decays(search.fits.study, search.record.alone, states[-1].summary)
        )
        unknown = [] if campaign.manifest.zero is not None else [UNKNOWN_ZERO_NOTE]
        findings = [str(finding) for finding in group_findings(campaign.findings)]
        worse = worsened_motions(search.fits.study, states[0].summary, states[-1].summary)
        every = (*signs, *search.fits.study.notes, *search.record.notes, *lost, *worse, *unknown, *findings)
        return conclude(campaign, search, states[0], states[-1], every, spent(), tuple(wrong.values()))

    try:
        joint = JointSearch(search)
        selected = joint.run(states, reach)
        states.append(Verification(search, joint).run(states[0], selected))
        if not unexplained_motions(search.fits, anatomy(search.fits, states[-1])):  # what is unexplained may have bent them
            states.append(with_mass_properties(search, states[-1]))
    except KeyboardInterrupt as stopped:
        stopping()
        stopped.partial = concluded()  # type: ignore[attr-defined]
        raise
    return concluded()
