"""What the command line prints of a campaign and of a calibration: heads and rows of tables, and lines."""

from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import replace

from calibration.campaign import Campaign
from calibration.checks import Finding
from calibration.classical import classical
from calibration.formatting import number, percent, with_deviation
from calibration.result import Calibration, Estimate
from jaxhydro.plot import for_people, unit_of

Rows = tuple[tuple[str, ...], Sequence[tuple[str, ...]]]
USE = {"fit": "fitted", "holdout": "held out", "ignore": "ignored"}


def counted(campaign: Campaign, kinds: Sequence[str] = ("decay",)) -> str:
    """How many tests of each use there are, and of those of other kinds."""
    tests = campaign.manifest.tests
    count = Counter(USE[t.use] if t.use == "ignore" or t.kind in kinds else f"left out ({t.kind})" for t in tests)
    order = {word: i for i, word in enumerate(USE.values())}
    there = [(count[word], word) for word in sorted(count, key=lambda word: (order.get(word, len(order)), word))]
    return ", ".join(f"{n} {'test' if n == 1 else 'tests'} {word}" for n, word in there)


def findings(found: Iterable[Finding]) -> Rows:
    """The warnings about the records."""
    return ("Test", "File", "Channel", "Warning"), [(one.test, one.file, one.channel, one.message) for one in found]


def parameters(result: Calibration) -> Rows:
    """Start, value and standard deviation of every parameter."""
    found = result.parameters.items()
    rows = [(label, number(one.start, 3), _value(one), one.unit, _flag(one)) for label, one in found]
    return ("Parameter", "Start", "Calibrated ± 1 sd", "Unit", ""), rows


def _value(one: Estimate) -> str:
    return with_deviation(one.value, one.standard_deviation) if one.identifiable else "not identifiable"


def _flag(one: Estimate) -> str:
    return "at its bound" if one.at_bound else ""


def errors(result: Calibration) -> Rows:
    """Errors of the scored channel of every test."""
    rows = []
    for test in result.tests:
        for series in test.series:
            if not series.scored:
                continue
            start = test.start.get(series.channel)
            before = None if start is None else replace(series, simulated=start).relative
            rmse = f"{number(float(for_people(series.channel, series.rmse)), 2)} {unit_of(series.channel)}"
            rows.append((test.id, USE[test.use], series.channel, percent(before), percent(series.relative), rmse))
    return ("Test", "Use", "Channel", "Before", "After", "RMSE"), rows


def linear_quadratic(result: Calibration) -> Rows:
    """The classical P-Q fit of every decay, measured and simulated, where it has cycles enough: 95 % intervals."""
    rows = []
    for test in result.tests:
        main = test.main
        if test.kind != "decay":
            continue
        try:
            found = [classical(test.time, x, main.noise).fit for x in (main.measured, main.simulated)]
        except ValueError:
            continue
        measured, simulated = found
        unit = "m" if unit_of(main.channel) == "m" else "rad"
        cells = [
            (with_deviation(float(a.value), 0.5 * float(a.upper - a.lower)), number(float(b.value), 3))
            for a, b in ((measured.linear, simulated.linear), (measured.quadratic, simulated.quadratic))
        ]
        rows.append((test.id, number(measured.period, 4), *cells[0], *cells[1], f"1/{unit}"))
    heads = ("Test", "Period (s)", "p ± 95 % (1/s)", "simulated", "q ± 95 %", "simulated", "Unit of q")
    return heads, rows


def bands(result: Calibration) -> Rows:
    """Errors of energy in bands, of tests in irregular waves."""
    names = {"low_frequency": "low", "wave_frequency": "wave"}
    rows = [
        (test.id, USE[test.use], channel, names.get(band, band), percent(one.before), percent(one.after))
        for test in result.tests for channel, row in test.bands.items() for band, one in row.items()
    ]  # fmt: skip
    return ("Test", "Use", "Motion", "Band", "Before", "After"), rows


def outcome(result: Calibration) -> str:
    """One line: J and how it was reached."""
    parts = [f"J = {number(result.objective('fit'), 3)} over the fitted tests"]
    if (holdout := result.objective("holdout")) is not None:
        parts.append(f"{number(holdout, 3)} over those held out")
    state = "converged" if result.converged else "stopped"
    return f"{', '.join(parts)}; {state} after {result.iterations} iterations, {result.seconds:.0f} s"


def against(result: Calibration, truth: dict[str, float]) -> Rows:
    """Calibrated values beside known ones."""
    rows = []
    for label, true in truth.items():
        one = result.parameters.get(label)
        if one is None:
            rows.append((label, number(true, 3), "not calibrated", "–", "–"))
            continue
        sd = one.standard_deviation
        off = one.value - true
        sure = one.identifiable and sd is not None and sd > 0
        sizes = (percent(off / true), f"{off / sd:+.1f} sd" if sure and sd else "–") if one.identifiable else ("–", "–")
        rows.append((label, number(true, 3), _value(one), *sizes))
    return ("Parameter", "True", "Calibrated ± 1 sd", "Off by", "in its sd"), rows


def unfinished(partial: Calibration) -> Calibration:
    """What was reached when the user stopped the fit, marked as not converged."""
    return replace(partial, converged=False, notes=("stopped by the user before it converged", *partial.notes))
