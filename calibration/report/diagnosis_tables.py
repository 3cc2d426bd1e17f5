"""Tables of a diagnosis, for the terminal and the page."""

from calibration.discovery.effects.effect_names import effect_in_words
from calibration.discovery.effects.nearly_known import CENTRE_ALONG, CENTRE_UP, INERTIA, MASS, STIFFNESS
from calibration.formatting import bracketed, number, percent, quantity, readable_unit, with_deviation
from calibration.report.diagnosis_words import (
    describe_limit,
    describe_probability,
    describe_range,
    is_determined,
    plain_name,
    sorted_by_certainty,
    validation_tests,
)
from calibration.results.calibration_file import Parameter
from calibration.results.diagnosis_file import DiagnosisFile
from calibration.vocabulary import BANDS, KINDS, UNDETERMINED, USE, Rows

USE_ORDER = list(USE)
MAX_RELATIVE_ERROR = 5.0  # a residual so many times its motion is of one that hardly moves: no share of it says anything
NEARLY_KNOWN = ("mass_properties.", "static_offset.", "mooring.", "covered_ends.")  # that a search lets vary by a little
MIN_TOLD = 1e-4  # a smaller part of an effect that is told apart is not worth its digits
NOT_OBSERVABLE = "these records would not show it at a plausible size"
VARIED = (
    "Properties that are nearly known, trim among them, fitted near the platform file's values. Standard deviations: mass "
    f"{percent(MASS)}, inertia {percent(INERTIA)}, moorings {percent(STIFFNESS)}. The centre of mass has "
    f"{100 * CENTRE_UP:.2g} % of the displaced volume's cube root upwards, {100 * CENTRE_ALONG:.1g} % lengthwise"
)


def tests(saved: DiagnosisFile) -> Rows:
    """Kind, file, use and length of every test."""
    rows = []
    for id, test in saved.tests.items():
        kind = " in ".join(filter(None, (KINDS.get(test.kind, test.kind), test.degree_of_freedom)))
        length = f"{number(test.duration, 3)} s" if test.duration is not None else ""
        rows.append((id, kind, test.file, USE.get(test.use, test.use), length))
    return ("Test", "Kind", "File", "Use", "Length"), rows


def effects(saved: DiagnosisFile) -> Rows:
    """Effects that were found: a row for every parameter."""
    rows = []
    for effect in saved.missing.effects:
        first = (
            effect_in_words(effect.effect, effect.degree_of_freedom),
            describe_probability(effect.evidence.probability),
            percent(effect.evidence.holdout_gain),
        )
        for i, (name, value) in enumerate(sorted_by_certainty(effect.parameters)):
            text = quantity(value.value, value.standard_deviation, value.unit)
            text = text if is_determined(value) else f"({quantity(value.value, None, value.unit)}) {UNDETERMINED}"
            size = (plain_name(name), text, describe_range(effect, name))
            rows.append((first[0], *size, *first[1:]) if i == 0 else ("", *size, "", ""))
    gain = f"Gain over {validation_tests(saved)}"
    return ("Effect", "Parameter", "Value ± 1 sd", "Plausible range", "Probability", gain), rows


def errors(saved: DiagnosisFile) -> Rows:
    """RMSE over the motion's standard deviation, before and after; fitted tests first.

    Only motions that count in the objective are listed.
    """
    before = {id: test_error.channels for id, test_error in saved.baseline.error.items()}
    rows = []
    for id in sorted(saved.augmented.error, key=lambda id: _order(saved, id)):
        use = _use(saved, id)
        for name, error in saved.augmented.error[id].channels.items():
            if error.in_objective:
                was = before.get(id, {}).get(name)
                both = percent(was.relative if was else None), percent(error.relative)
                rows.append((id, USE[use], name, *both, f"{number(error.rmse, 2)} {error.unit}"))
    return ("Test", "Use", "Motion", "Before", "After", "RMSE after"), rows


def bands(saved: DiagnosisFile) -> Rows:
    """Errors of energy in the bands of tests in irregular waves."""
    rows = []
    for id in sorted(saved.augmented.error, key=lambda id: _order(saved, id)):
        before = saved.baseline.error.get(id)
        was = before.bands if before else {}
        for channel, row in saved.augmented.error[id].bands.items():
            for band, value in row.items():
                then = was.get(channel, {}).get(band)
                use = _use(saved, id)
                rows.append((id, USE[use], channel, BANDS.get(band, band), percent(then), percent(value)))
    return ("Test", "Use", "Motion", "Band", "Before", "After"), rows


def predictions(saved: DiagnosisFile) -> Rows:
    """Bands of the predicted motions of held-out tests, and how many samples they hold."""
    rows = []
    for prediction in saved.predictions:
        errors = (number(value, 2) for value in (prediction.half_width, prediction.parameter_error, prediction.model_error))
        rows.append((prediction.test, prediction.channel, prediction.unit, *errors, percent(prediction.inside)))
    return ("Test", "Motion", "Unit", "Half-width", "Parameters", "Model and noise", "Samples inside"), rows


def coefficients(saved: DiagnosisFile) -> Rows:
    """Every fitted parameter as declared, before and after, the effects' own among those after."""
    rows = []
    for label, was, now in _parameters(saved, nearly_known=False):
        comparable = was is not None and now is not None and is_determined(was) and is_determined(now) and was.value != 0
        moved = _moved(now.value / was.value - 1) if comparable and was and now else ""
        rows.append((*_of_parameter(label, was, now), moved))
    return ("Parameter", "Declared", "Fitted before", "Fitted after", "Unit", "Moved by"), rows


def nearly_known(saved: DiagnosisFile) -> Rows:
    """Fitted properties that are nearly known, before and after.

    A search lets them vary though nobody declared them.
    """
    rows = [_of_parameter(*row) for row in _parameters(saved, nearly_known=True)]
    return ("Parameter", "Declared", "Fitted before", "Fitted after", "Unit"), rows


def _moved(ratio: float) -> str:
    return f"{100 * ratio:+.2g} %" if abs(ratio) < 0.995 else f"{100 * ratio:+.0f} %"


def _parameters(saved: DiagnosisFile, nearly_known: bool) -> list[tuple[str, Parameter | None, Parameter | None]]:
    """Labels with their fitted parameters before and after."""
    before, after = saved.baseline.parameters, saved.augmented.parameters
    labels = [label for label in dict.fromkeys([*before, *after]) if label.startswith(NEARLY_KNOWN) == nearly_known]
    rows = [(label, before.get(label), after.get(label)) for label in labels]
    return sorted(rows, key=lambda row: row[0] not in before and row[2] is not None and not is_determined(row[2]))


def _of_parameter(label: str, was: Parameter | None, now: Parameter | None) -> tuple[str, ...]:
    unit = next((parameter.unit for parameter in (now, was) if parameter is not None), "")
    return label, number(was.start if was is not None else None, 3), _value(was), _value(now), readable_unit(unit)


def rejected(saved: DiagnosisFile) -> Rows:
    """Effects that were tried and are not in the model; those with the same reason share a row."""
    reasons: dict[str, list[str]] = {}
    for rejection in saved.missing.rejected:
        reason = rejection.reason if rejection.observable else f"{rejection.reason}; {NOT_OBSERVABLE}"
        reasons.setdefault(reason, []).append(effect_in_words(rejection.effect, rejection.degree_of_freedom))
    rows = [("; ".join(names), reason) for reason, names in reasons.items()]
    return ("Effect", "Why not"), rows


def detection_limits(saved: DiagnosisFile) -> Rows:
    """Sizes from which effects that are not named would have been, beside their largest plausible sizes."""
    rows = []
    for rejection in saved.missing.rejected:
        words = effect_in_words(rejection.effect, rejection.degree_of_freedom)
        for i, (name, limit) in enumerate(rejection.detection_limits.items()):
            row = (plain_name(name), describe_limit(limit), quantity(limit.plausible, None, limit.unit), told_apart(limit.told))
            rows.append(("" if i else words, *row))
    return ("Effect", "Parameter", "Named from", "Plausible up to", "Told apart"), rows


def told_apart(fraction: float) -> str:
    """A fraction in per cent, of which the smallest are not worth their digits."""
    return percent(fraction) if fraction >= MIN_TOLD else f"below {percent(MIN_TOLD)}"


def anatomy(saved: DiagnosisFile) -> Rows:
    """The residual before, motion by motion, the largest first, and what became of it."""
    after = {(residual.test, residual.channel): residual for residual in saved.anatomy.after}
    rows = []
    for residual in sorted(saved.anatomy.before, key=lambda residual: -(residual.over_noise or 0.0)):
        now = after.get((residual.test, residual.channel))
        rows.append(
            (
                residual.test,
                USE.get(residual.use, residual.use),
                residual.channel,
                residual.words,
                f"{number(residual.rms, 2)} {residual.unit}",
                percent(residual.relative if (residual.relative or 0.0) < MAX_RELATIVE_ERROR else None),
                number(residual.over_noise, 2),
                number(now.over_noise if now else None, 2),
            )
        )
    return ("Test", "Use", "Motion", "What is left", "Residual", "Of motion", "Over noise", "Over noise, after"), rows


def _value(parameter: Parameter | None) -> str:
    if parameter is None:
        return "–"
    value = with_deviation(parameter.value, parameter.standard_deviation)
    text = value if is_determined(parameter) else f"{bracketed(parameter.value)} {UNDETERMINED}"
    return f"{text}, at its bound" if parameter.at_bound else text


def _use(saved: DiagnosisFile, id: str) -> str:
    return saved.augmented.error[id].use


def _order(saved: DiagnosisFile, id: str) -> int:
    return USE_ORDER.index(_use(saved, id))
