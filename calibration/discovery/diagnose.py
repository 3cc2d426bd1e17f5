"""What a model of a campaign lacks, from the records to the conclusion: the search, kept as it goes."""

import math
import time as clock
import warnings
from collections.abc import Callable, Sequence
from pathlib import Path

from calibration.campaign.grouped_findings import group_findings
from calibration.campaign.load_campaign import Campaign
from calibration.discovery.acceptance import State, given_up
from calibration.discovery.channel_signs import in_words, reversed_channels, turned
from calibration.discovery.checkpoint import keep, resumed
from calibration.discovery.diagnosis import Diagnosis
from calibration.discovery.diagnosis_conclusion import conclude, much
from calibration.discovery.effects.candidates import Candidate
from calibration.discovery.greedy_search import ROUNDS, Search
from calibration.discovery.residual_anatomy import anatomy
from calibration.discovery.set_up import pose
from calibration.discovery.strip_trials import Conventions, conventions_of
from calibration.discovery.wave_records import by_a_program, options_for
from calibration.fitting.decay_fit import Progress
from calibration.residuals.measured_seas import NO_ZERO, Options
from jaxhydro.dynamics.model import Model
from jaxhydro.errors import CheckpointWarning
from jaxhydro.interrupts import stopping

ABSOLUTE = f"{NO_ZERO}, so that a sensor's zero elsewhere is taken for ballast, or for a force"


def diagnose(
    model: Model,
    campaign: Campaign,
    *,
    candidates: Sequence[Candidate] = (),
    progress: Callable[[Progress], None] | None = None,
    options: Options | None = None,
    kept: Path | None = None,
) -> Diagnosis:
    """What a model of a campaign (that declared: `campaign.model`) lacks: found, added, judged by the tests marked `holdout`.

    `candidates` of one's own take part beside the catalogue's. `kept` is a file that has what was reached by round; where it is
    there, of the same campaign, options, program and libraries, the search goes on from it; where it is of others or damaged,
    a CheckpointWarning says so and the search starts anew. Raises InputError where a campaign has nothing to diagnose,
    and KeyboardInterrupt where it is stopped, what was found until then as its `partial`.
    """
    begun, campaign = clock.monotonic(), campaign.with_model(model)

    def say(stage: str, fraction: float) -> None:
        if progress is not None:
            progress(Progress(stage, 0, math.nan, fraction, "-2 ln L"))

    states: list[State] = []
    unusable: list[str] = []  # why what an earlier run reached is left alone

    def spent() -> float:
        return search.earlier + clock.monotonic() - begun

    def reach(state: State) -> None:
        states.append(state)
        if kept is not None:
            keep(kept, search, states, spent())

    say("reading the records", 0.0)

    def begun_with(campaign: Campaign) -> tuple[Search, tuple[str, ...]]:
        how, notes = options_for(campaign) if options is None else (options, ())
        taken = conventions_of(campaign, say) if by_a_program(how) else Conventions(campaign)
        search = Search(taken.campaign, pose(taken.campaign, how, candidates), say)
        search.plain, search.strips, notes = taken.fit, taken.strips, (*notes, *taken.notes)
        states.extend([] if kept is None else resumed(kept, search, unusable.append))
        return search, notes

    search, notes = begun_with(campaign)
    wrong = {} if states else reversed_channels(campaign, search)
    if wrong:
        search, notes = begun_with(campaign := turned(campaign, list(wrong)))
        notes = (in_words(list(wrong)), *notes)
    if states:
        say(f"going on from what was reached before: round {len(states)}", 0.15)
    else:
        if unusable:
            warnings.warn(unusable[-1], CheckpointWarning, stacklevel=2)
        reach(search.declared())

    def concluded() -> Diagnosis:
        lost = [] if search.alone is None else given_up(search.study, search.alone, states[-1].left)
        unknown = [] if campaign.manifest.zero is not None else [ABSOLUTE]
        warnings = [str(finding) for finding in group_findings(campaign.findings)]
        every = (*notes, *search.notes, *lost, *unknown, *warnings)
        return conclude(search.campaign, search, states[0], states[-1], every, spent(), tuple(wrong.values()))

    try:
        for again in range(2 * ROUNDS):
            if len(states) > ROUNDS:  # an earlier run may have reached them
                break
            if len(states) > 1 and (second := search.in_second_order(states[-1], len(states))) is not None:
                states[0], states[-1] = second
            states[-1], after = search.grow(fitted := states[-1], len(states))
            if after is not None:
                reach(after)
            elif states[-1] is fitted or again >= ROUNDS:
                break
        if len(states) > ROUNDS:
            search.notes.append(f"the search ended with the effect number {ROUNDS}, not because nothing more was found")
        states.append(search.pruned(states[-1]))
        if not much(search, anatomy(search, states[-1])):  # what is unexplained may have bent them
            states.append(search.weighed(states[-1]))
    except KeyboardInterrupt as stopped:
        stopping()
        stopped.partial = concluded()  # type: ignore[attr-defined]
        raise
    return concluded()
