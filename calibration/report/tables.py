"""Tables of a campaign and of a calibration, for the terminal and the page."""

from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import replace

from calibration.campaign.finding import Finding
from calibration.campaign.grouped_findings import group_findings
from calibration.campaign.load_campaign import Campaign
from calibration.campaign.manifest_sections import IN_WAVES
from calibration.formatting import bracketed, counted, listed, number, percent, readable_unit, signed_percent, with_deviation
from calibration.report.summary import damping_far_outside
from calibration.result import Calibration
from calibration.results.calibration_file import CalibrationFile, ChannelError, Parameter
from calibration.vocabulary import BANDS, KINDS, UNDETERMINED, USE, Rows

CLASSICAL = "Classical (P-Q) analysis of the decays: x'' + p x' + q x'|x'| + w² x = 0"
MAX_NAMED_DECAYS = 3
AGREEMENT_DEVIATIONS = 2.0  # standard deviations within which a value agrees with the true one


def count_tests(campaign: Campaign, kinds: Sequence[str] = ("decay",)) -> str:
    """How many tests there are of each use, and how many of other kinds are left out."""
    tests = campaign.manifest.tests
    count = Counter(USE[t.use] if t.use == "ignore" or t.kind in kinds else f"left out ({t.kind})" for t in tests)
    order = {word: i for i, word in enumerate(USE.values())}
    counts = [(count[word], word) for word in sorted(count, key=lambda word: (order.get(word, len(order)), word))]
    return ", ".join(f"{n} {'test' if n == 1 else 'tests'} {word}" for n, word in counts)


def findings(warnings: Iterable[Finding]) -> Rows:
    """The warnings about the records, each once."""
    return ("Test", "File", "Channel", "Warning"), [
        (group.where, group.source, group.channel, group.message) for group in group_findings(warnings)
    ]


def parameters(saved: CalibrationFile) -> Rows:
    """Meaning, start, value and standard deviation of every coefficient."""
    rows = [
        (label, parameter.meaning, number(parameter.start, 3), value_text(parameter), readable_unit(parameter.unit))
        for label, parameter in saved.baseline.parameters.items()
    ]
    return ("Parameter", "Meaning", "Start", "Calibrated ± 1 sd", "Unit"), rows


def value_text(parameter: Parameter) -> str:
    """A calibrated value with its standard deviation; in brackets where the records do not determine it."""
    value = with_deviation(parameter.value, parameter.standard_deviation)
    text = value if parameter.identifiable else f"{bracketed(parameter.value)} {UNDETERMINED}"
    return f"{text}, at its bound" if parameter.at_bound else text


def errors(saved: CalibrationFile) -> Rows:
    """Errors of the motions that count in the fit, of every test."""
    rows = []
    for id, error in saved.baseline.error.items():
        scored = {name: channel for name, channel in error.channels.items() if channel.in_objective}
        rows += [(id, *_test(saved, id), name, *_error(channel)) for name, channel in scored.items()]
        if not error.channels:
            rows.append((id, *_test(saved, id), "", "–", "not finite", ""))
    return ("Test", "Kind", "Length", "Use", "Motion", "Before", "After", "RMSE"), rows


def other_motions(saved: CalibrationFile) -> Rows:
    """Errors of the motions beside those that count in the fit."""
    rows = []
    for id, error in saved.baseline.error.items():
        others = {name: channel for name, channel in error.channels.items() if not channel.in_objective}
        rows += [(id, _use(saved, id), name, *_error(channel)) for name, channel in others.items()]
    return ("Test", "Use", "Motion", "Before", "After", "RMSE"), rows


def _test(saved: CalibrationFile, id: str) -> tuple[str, str, str]:
    """Kind, length and use of a test."""
    about = saved.tests.get(id)
    kind = " in ".join(filter(None, (KINDS.get(about.kind, about.kind), about.degree_of_freedom))) if about else ""
    length = f"{number(about.duration, 3)} s" if about and about.duration is not None else ""
    return kind, length, _use(saved, id)


def _use(saved: CalibrationFile, id: str) -> str:
    return USE[saved.baseline.error[id].use]


def _error(error: ChannelError) -> tuple[str, str, str]:
    """Before and after calibration, over the motion's standard deviation; RMSE after."""
    before = percent(error.before.relative) if error.before is not None else "–"
    return before, percent(error.relative), f"{number(error.rmse, 2)} {error.unit}"


def linear_quadratic(saved: CalibrationFile) -> Rows:
    """The classical linear and quadratic damping of every decay with enough cycles.

    Both are measured and simulated.
    """
    rows = []
    for id, about in saved.tests.items():
        if (damping := about.linear_quadratic) is not None:
            values = [
                text
                for term in (damping.linear, damping.quadratic)
                for text in (with_deviation(term.measured, term.half_width), number(term.simulated, 3))
            ]
            rows.append((id, number(damping.period, 4), *values, f"1/{damping.unit}"))
    heads = ("Test", "Period (s)", "p measured ± 95 % (1/s)", "p simulated (1/s)", "q measured ± 95 %", "q simulated")
    return (*heads, "Unit of q"), rows


def damping_outside(saved: CalibrationFile) -> str:
    """Sentences on decays whose simulated damping is far outside the measured interval.

    Returns:
        The sentences; "" where there is no such decay.
    """
    outside = [f"{' and '.join(terms)} of {id}" for id, terms in damping_far_outside(saved).items()]
    if not outside:
        return ""
    more = len(outside) - MAX_NAMED_DECAYS
    named = listed([*outside[:MAX_NAMED_DECAYS], *([counted(more, "further decay")] if more > 0 else [])])
    return (
        f"Far outside the measured interval: {named}. The platform's damping grows with the amplitude in another way than the "
        "model's: `jaxhydro diagnose` looks for what the model lacks."
    )


def bands(saved: CalibrationFile) -> Rows:
    """Errors of energy in bands, of tests in irregular waves."""
    rows = [
        (id, _use(saved, id), channel, BANDS.get(band, band.replace("_", " ")), *map(signed_percent, both))
        for id, channels in saved.bands().items()
        for channel, row in channels.items()
        for band, both in row.items()
    ]
    return ("Test", "Use", "Motion", "Band", "Before", "After"), rows


def outcome_sentence(saved: CalibrationFile) -> str:
    """One line: the objective J and how it was reached.

    Tests in waves are fitted by other objectives, so J is not called the objective of these.
    """
    fitted = saved.baseline
    in_waves = any(test.use == "fit" and test.kind in IN_WAVES for test in saved.tests.values())
    name = "J, the sum" if in_waves else "Objective J, the sum"
    parts = [f"{name} of RMSE over standard deviation: {number(fitted.objective.fit, 3)} over the fitted tests"]
    if fitted.objective.holdout is not None:
        parts.append(f"{number(fitted.objective.holdout, 3)} over those held out")
    if fitted.iterations is not None and fitted.seconds is not None:
        state = "converged" if fitted.converged else "stopped"
        parts.append(f"{state} after {counted(fitted.iterations, 'iteration')} in {fitted.seconds:.0f} s")
    return ", ".join(parts)


def comparison_with_truth(saved: CalibrationFile) -> Rows:
    """Calibrated values beside the true ones."""
    rows = []
    for label, true in saved.truth.items():
        parameter = saved.baseline.parameters.get(label)
        if parameter is None:
            rows.append((label, number(true, 3), "not calibrated", "", "–", "–"))
            continue
        sizes = ("–", "–")
        if parameter.identifiable:
            away = deviations_away(parameter, true)
            sizes = (percent((parameter.value - true) / true) if true else "–", "–" if away is None else f"{away:+.1f} sd")
        rows.append((label, number(true, 3), value_text(parameter), readable_unit(parameter.unit), *sizes))
    return ("Parameter", "True", "Calibrated ± 1 sd", "Unit", "Off by", "Off by, in sd"), rows


def deviations_away(parameter: Parameter, true: float) -> float | None:
    """Standard deviations from the true value; None where the records do not determine the coefficient."""
    sd = parameter.standard_deviation
    return (parameter.value - true) / sd if parameter.identifiable and sd is not None and sd > 0 else None


def agreement_with_truth(saved: CalibrationFile) -> str:
    """How many coefficients lie near the true values, in a sentence."""
    calibrated = {label: saved.baseline.parameters.get(label) for label in saved.truth}
    away = [
        None if parameter is None else deviations_away(parameter, saved.truth[label]) for label, parameter in calibrated.items()
    ]
    near = sum(sd is not None and abs(sd) <= AGREEMENT_DEVIATIONS for sd in away)
    largest = max((abs(sd) for sd in away if sd is not None), default=None)
    farthest = "" if largest is None else f"; the farthest is {largest:.1f} away"
    limit = f"{AGREEMENT_DEVIATIONS:g} standard deviations"
    return f"{near} of {len(away)} coefficients lie within {limit} of the true values{farthest}."


def mark_unfinished(partial: Calibration) -> Calibration:
    """Mark a calibration that the user stopped as not converged."""
    return replace(partial, converged=False, notes=("stopped by the user before it converged", *partial.notes))
