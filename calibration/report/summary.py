"""Result of a calibration in one sentence."""

import re
from collections.abc import Iterator, Mapping, Sequence
from typing import NamedTuple

from calibration.fitting.fit_conclusion import NOT_FOLLOWED_ERROR
from calibration.formatting import counted, listed, percent, percent_span
from calibration.results.calibration_file import CalibrationFile, ChannelError, Parameter

KINDS = {"decay": "decay", "regular": "test", "irregular": "test"}
WAVES_PHRASES = {"regular": " in regular waves", "irregular": " in irregular waves"}
BANDS = {"low_frequency": "low-frequency", "wave_frequency": "wave-frequency"}
FAR_OFF_ERROR = 1.0  # relative error of the energy in a band beyond which a test in waves is not followed
MAX_NAMED = 3  # tests or coefficients that a sentence names; of more it says how many
Bands = Mapping[str, Mapping[str, tuple[float | None, float]]]


class Agreement(NamedTuple):
    """How well the tests of one kind and one use are followed.

    `errors` are RMSE over the standard deviation of the measured motion, one for each scored motion. `bands` are the absolute
    relative errors of energy, by band; where there are any, the sentence has these.
    """

    kind: str
    use: str
    tests: int
    errors: tuple[float, ...]
    bands: dict[str, tuple[float, ...]]


class FarOff(NamedTuple):
    """The band of a motion whose energy is farthest off, and its absolute relative error."""

    channel: str
    band: str
    error: float


class CalibrationSummary(NamedTuple):
    """What the sentence says. `not_followed` are fitted decays by id, with RMSE over standard deviation; `far_off` are fitted
    tests in irregular waves whose energy is off by more than `FAR_OFF_ERROR` in a band."""

    converged: bool
    not_followed: dict[str, float]
    far_off: dict[str, FarOff]
    agreements: tuple[Agreement, ...]
    determined: tuple[str, ...]
    undetermined: tuple[str, ...]
    at_bound: tuple[str, ...]

    @property
    def sound(self) -> bool:
        """Whether the fit converged and follows what it was made to."""
        return self.converged and not self.not_followed and not self.far_off


def summary_of(saved: CalibrationFile) -> CalibrationSummary:
    """Summary of a calibration."""
    errors, bands = {id: one.channels for id, one in saved.baseline.error.items()}, saved.bands()
    groups: dict[tuple[str, str], list[str]] = {}
    lost: dict[str, float] = {}
    far: dict[str, FarOff] = {}
    for id, channels in errors.items():
        kind, use = _kind(saved, id), saved.baseline.error[id].use
        if use in ("fit", "holdout"):
            groups.setdefault((use, kind), []).append(id)
        scored = [one.relative for one in channels.values() if one.in_objective]
        if use == "fit" and kind == "decay" and scored and max(scored) >= NOT_FOLLOWED_ERROR:
            lost[id] = max(scored)
        energies = [FarOff(name, band, abs(after)) for name, row in bands[id].items() for band, (_, after) in row.items()]
        worst = max(energies, key=lambda one: one.error, default=None)
        if use == "fit" and worst is not None and worst.error > FAR_OFF_ERROR:
            far[id] = worst
    agreements = tuple(
        _agreement(kind, use, [errors[id] for id in ids], [bands[id] for id in ids])
        for (use, kind), ids in sorted(groups.items(), key=lambda item: item[0][0])  # "fit" before "holdout"
    )
    parameters = saved.baseline.parameters
    determined = tuple(label for label, one in parameters.items() if _is_determined(one))
    return CalibrationSummary(saved.baseline.converged, lost, far, agreements, determined, *_others(parameters, determined))


def _is_determined(one: Parameter) -> bool:
    """Whether the records determine a coefficient: identifiable, off its bounds, and larger than its standard deviation."""
    return one.identifiable and not one.at_bound and (one.standard_deviation or 0.0) <= abs(one.value)


def _kind(saved: CalibrationFile, id: str) -> str:
    return saved.tests[id].kind if id in saved.tests else ""


def _others(parameters: Mapping[str, Parameter], determined: Sequence[str]) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Coefficients that are not determined, and those that are at a bound."""
    rest = [label for label in parameters if label not in determined]
    return (
        tuple(label for label in rest if not parameters[label].at_bound),
        tuple(label for label in rest if parameters[label].at_bound),
    )


def _agreement(kind: str, use: str, errors: Sequence[Mapping[str, ChannelError]], bands: Sequence[Bands]) -> Agreement:
    relative = tuple(one.relative for channels in errors for one in channels.values() if one.in_objective)
    energies: dict[str, list[float]] = {}
    for channels in bands:
        for row in channels.values():
            for band, (_, after) in row.items():
                energies.setdefault(band, []).append(abs(after))
    return Agreement(kind, use, len(errors), relative, {band: tuple(values) for band, values in energies.items()})


def calibration_sentence(summary: CalibrationSummary) -> str:
    """What the calibration came to. What went wrong comes first.

    "9 decays followed to 0.4-1.7 %; all 11 coefficients determined."
    """
    # of a model that does not follow a decay, values mean little
    known = [] if summary.not_followed else [_determined(summary)]
    parts = [*map(agreement_phrase, summary.agreements), *known]
    # bands make clauses long: they are sentences of their own
    said = [f"{part}." for part in parts] if any(one.bands for one in summary.agreements) else [f"{'; '.join(parts)}."]
    return " ".join([*_failures(summary), *(re.sub("^(all|no) ", lambda word: word[0].capitalize(), one) for one in said)])


def _failures(summary: CalibrationSummary) -> Iterator[str]:
    lost = summary.not_followed
    if lost:
        worst = max(lost.values())
        yield f"The model does not follow {_named(list(lost), 'decay')}: RMSE up to {percent(worst)} of the motion."
    if summary.far_off:
        id, off = max(summary.far_off.items(), key=lambda item: item[1].error)
        energy = f"{BANDS.get(off.band, off.band)} {off.channel} energy"
        several = f" of {id}" if len(summary.far_off) > 1 else ""
        tests = _named(list(summary.far_off), "test")
        yield f"The model does not follow {tests}: the {energy}{several} is off by {percent_span([off.error])}."
    if not summary.converged and not lost:  # a fit that leaves a record behind is marked as not converged, too
        yield "The fit did not converge."


def agreement_phrase(one: Agreement) -> str:
    """How well the tests of one kind and use are followed: "9 decays followed to 0.4-1.7 %"."""
    held = "held-out " if one.use == "holdout" else ""
    tests = counted(one.tests, f"{held}{KINDS.get(one.kind, 'test')}") + WAVES_PHRASES.get(one.kind, "")
    if one.bands:
        parts = [f"{BANDS.get(band, band)} energy off by {percent_span(values)}" for band, values in one.bands.items()]
        return f"{tests}: {listed(parts)}"
    return f"{tests} followed to {percent_span(one.errors)}" if one.errors else f"{tests} not followed"


def _determined(summary: CalibrationSummary) -> str:
    known, vague, bound = summary.determined, summary.undetermined, summary.at_bound
    total = len(known) + len(vague) + len(bound)
    if not total:
        return "no coefficient fitted"
    if total == 1 and not known:
        return f"{bound[0]} is at a bound" if bound else f"{vague[0]} not determined"
    if total == len(known):
        return f"all {total} coefficients determined" if total > 1 else f"{known[0]} determined"
    said = f"{len(known)} of {counted(total, 'coefficient')} determined"
    if vague:
        said += f"; not determined: {_named(vague, 'coefficient')}"
    return f"{said}; at a bound: {_named(bound, 'coefficient')}" if bound else said


def _named(names: Sequence[str], noun: str) -> str:
    """Names while they are few, else how many."""
    return listed(names) if len(names) <= MAX_NAMED else counted(len(names), noun)
