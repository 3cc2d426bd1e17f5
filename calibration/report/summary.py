"""Result of a calibration in one sentence."""

import re
from collections.abc import Iterator, Mapping, Sequence
from typing import NamedTuple

from calibration.formatting import counted, listed, percent, percent_span
from calibration.result import NOT_FOLLOWED_ERROR
from calibration.results.calibration_file import CalibrationFile, ChannelError, Parameter

KINDS = {"decay": "decay", "regular": "test", "irregular": "test"}
WAVES_PHRASES = {"regular": " in regular waves", "irregular": " in irregular waves"}
BANDS = {"low_frequency": "low-frequency", "wave_frequency": "wave-frequency"}
FAR_OFF_ERROR = 1.0  # relative error of the energy in a band beyond which a test in waves is not followed
MAX_HALF_WIDTHS = 1.5  # of a 95 % interval (3 standard deviations): a simulated value beyond is no chance
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
    """Facts for the sentence on a calibration.

    Attributes:
        converged: Whether the fit converged.
        not_followed: Fitted decays that the model does not follow, with RMSE over standard deviation (-).
        far_off: Fitted tests in irregular waves whose energy is off by more than `FAR_OFF_ERROR` in a band.
        agreements: How well the tests of each kind and use are followed.
        determined: Coefficients that the records determine.
        undetermined: Coefficients that they do not determine.
        at_bound: Coefficients that are at a bound.
        damping_outside: Fitted decays whose simulated damping is far outside the measured interval.
    """

    converged: bool
    not_followed: dict[str, float]
    far_off: dict[str, FarOff]
    agreements: tuple[Agreement, ...]
    determined: tuple[str, ...]
    undetermined: tuple[str, ...]
    at_bound: tuple[str, ...]
    damping_outside: tuple[str, ...] = ()

    @property
    def sound(self) -> bool:
        """Whether the fit converged and follows what it was made to."""
        return self.converged and not self.not_followed and not self.far_off


def summary_of(saved: CalibrationFile) -> CalibrationSummary:
    """Summary of a calibration."""
    errors, bands = {id: test_error.channels for id, test_error in saved.baseline.error.items()}, saved.bands()
    groups: dict[tuple[str, str], list[str]] = {}
    lost: dict[str, float] = {}
    far: dict[str, FarOff] = {}
    for id, channels in errors.items():
        kind, use = _kind(saved, id), saved.baseline.error[id].use
        if use in ("fit", "holdout"):
            groups.setdefault((use, kind), []).append(id)
        scored = [channel.relative for channel in channels.values() if channel.in_objective]
        if use == "fit" and kind == "decay" and scored and max(scored) >= NOT_FOLLOWED_ERROR:
            lost[id] = max(scored)
        energies = [FarOff(name, band, abs(after)) for name, row in bands[id].items() for band, (_, after) in row.items()]
        worst = max(energies, key=lambda energy: energy.error, default=None)
        if use == "fit" and worst is not None and worst.error > FAR_OFF_ERROR:
            far[id] = worst
    agreements = tuple(
        _agreement(kind, use, [errors[id] for id in ids], [bands[id] for id in ids])
        for (use, kind), ids in sorted(groups.items(), key=lambda item: item[0][0])  # "fit" before "holdout"
    )
    parameters = saved.baseline.parameters
    determined = tuple(label for label, parameter in parameters.items() if _is_determined(parameter))
    outside = tuple(id for id in damping_far_outside(saved) if saved.tests[id].use == "fit")
    others = _others(parameters, determined)
    return CalibrationSummary(saved.baseline.converged, lost, far, agreements, determined, *others, outside)


def damping_far_outside(saved: CalibrationFile) -> dict[str, list[str]]:
    """Decays whose simulated linear (p) or quadratic (q) damping is far outside the measured interval, with these terms."""
    outside = {}
    for id, about in saved.tests.items():
        if (both := about.linear_quadratic) is not None:
            terms = {"p": both.linear, "q": both.quadratic}
            far = [
                name for name, term in terms.items() if abs(term.simulated - term.measured) > MAX_HALF_WIDTHS * term.half_width
            ]
            if far:
                outside[id] = far
    return outside


def _is_determined(parameter: Parameter) -> bool:
    """Whether the records determine a coefficient.

    It is identifiable, off its bounds, and no smaller than its standard deviation.
    """
    return parameter.identifiable and not parameter.at_bound and (parameter.standard_deviation or 0.0) <= abs(parameter.value)


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
    relative = tuple(channel.relative for channels in errors for channel in channels.values() if channel.in_objective)
    energies: dict[str, list[float]] = {}
    for channels in bands:
        for row in channels.values():
            for band, (_, after) in row.items():
                energies.setdefault(band, []).append(abs(after))
    return Agreement(kind, use, len(errors), relative, {band: tuple(values) for band, values in energies.items()})


def calibration_sentence(summary: CalibrationSummary) -> str:
    """Result of a calibration in one sentence, failures first.

    "9 decays followed to 0.4-1.7 %; all 11 coefficients determined."
    """
    # of a model that does not follow a decay, values mean little
    determined = [] if summary.not_followed else [_determined(summary)]
    lost = len(summary.not_followed)
    followed = [a for a in summary.agreements if not (a.kind == "decay" and a.use == "fit" and lost >= a.tests)]
    parts = [*map(agreement_phrase, followed), *determined]
    # bands make clauses long: they are sentences of their own
    apart = any(agreement.bands for agreement in followed)
    sentences = [f"{part}." for part in parts] if apart or not parts else [f"{'; '.join(parts)}."]
    capitalised = [re.sub("^(all|no) ", lambda word: word[0].capitalize(), sentence) for sentence in sentences]
    if summary.damping_outside and not lost:
        capitalised.append(f"The damping of {_named(summary.damping_outside, 'decay')} is far outside the measured interval.")
    return " ".join([*_failures(summary), *capitalised])


def _failures(summary: CalibrationSummary) -> Iterator[str]:
    lost = summary.not_followed
    if lost:
        worst = max(lost.values())
        at_most = "up to " if len(lost) > 1 else ""
        yield f"The model does not follow {_named(list(lost), 'decay')}: RMSE {at_most}{percent(worst)} of the motion."
    if summary.far_off:
        id, off = max(summary.far_off.items(), key=lambda item: item[1].error)
        energy = f"{BANDS.get(off.band, off.band)} {off.channel} energy"
        several = f" of {id}" if len(summary.far_off) > 1 else ""
        tests = _named(list(summary.far_off), "test")
        yield f"The model does not follow {tests}: the {energy}{several} is off by {percent_span([off.error])}."
    if not summary.converged and not lost:  # a fit that leaves a record behind is marked as not converged, too
        yield "The fit did not converge."


def agreement_phrase(agreement: Agreement) -> str:
    """How well the tests of one kind and use are followed: "9 decays followed to 0.4-1.7 %"."""
    held = "held-out " if agreement.use == "holdout" else ""
    tests = counted(agreement.tests, f"{held}{KINDS.get(agreement.kind, 'test')}") + WAVES_PHRASES.get(agreement.kind, "")
    if agreement.bands:
        parts = [f"{BANDS.get(band, band)} energy off by {percent_span(values)}" for band, values in agreement.bands.items()]
        return f"{tests}: {listed(parts)}"
    return f"{tests} followed to {percent_span(agreement.errors)}" if agreement.errors else f"{tests} not followed"


def _determined(summary: CalibrationSummary) -> str:
    determined, vague, bound = summary.determined, summary.undetermined, summary.at_bound
    total = len(determined) + len(vague) + len(bound)
    if not total:
        return "no coefficient fitted"
    if total == 1 and not determined:
        return f"{bound[0]} is at a bound" if bound else f"{vague[0]} not determined"
    if total == len(determined):
        return f"all {total} coefficients determined" if total > 1 else f"{determined[0]} determined"
    text = f"{len(determined)} of {counted(total, 'coefficient')} determined"
    if vague:
        text += f"; not determined: {_named(vague, 'coefficient')}"
    return f"{text}; at a bound: {_named(bound, 'coefficient')}" if bound else text


def _named(names: Sequence[str], noun: str) -> str:
    """Names while they are few, else how many."""
    return listed(names) if len(names) <= MAX_NAMED else counted(len(names), noun)
