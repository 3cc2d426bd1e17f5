"""Sentences and readable numbers of a diagnosis, for the terminal and the page."""

from collections.abc import Mapping

from calibration.discovery.diagnosis import Outcome
from calibration.discovery.effects.effect_names import capitalised, effect_in_words
from calibration.discovery.reported_effects import WAVE_ORDER
from calibration.formatting import listed, number, percent, quantity, quantity_range
from calibration.results.calibration_file import Parameter
from calibration.results.diagnosis_file import DetectionLimit, DiagnosisFile, Evidence, FoundEffect
from calibration.vocabulary import UNDETERMINED

STOPPED = "stopped by the user before it was done: what follows is what was found until then"
UNFINISHED = "The search did not come to its end: until then nothing was found that the model lacks."
WAVES_FIRST = (
    "The wave records lack the second-order waves that the model is driven with. State `records` in campaign.yaml (see the "
    "notes), and diagnose again."
)
WHERE = "in the motion and at the frequencies where the error falls most"
SAME_LIMIT = 1.05  # ratio of two detection limits that are shown as one
NEAR_ZERO_DEVIATIONS = 2.0  # standard deviations from zero: below, it is said that a parameter is near zero
SMALL_DEVIATION = 0.25  # of the value it began from: a deviation below is small, whatever the value
EVIDENCE_STRENGTHS = (
    (10.0, "very strong"),
    (6.0, "strong"),
    (2.0, "positive"),
    (0.0, "weak"),
)  # Kass and Raftery 1995, table in 3.2


def plain_name(name: str) -> str:
    """A parameter's name in words: `column.exponent` is "column exponent"."""
    return name.replace(".", " ").replace("_", " ")


def is_determined(parameter: Parameter) -> bool:
    """Whether the records determine a parameter.

    Its standard deviation is below its value, or small against the value that the fit began from.
    """
    deviation = parameter.standard_deviation or 0.0
    return parameter.identifiable and (
        deviation <= abs(parameter.value) or deviation < SMALL_DEVIATION * abs(parameter.start or 0.0)
    )


def sorted_by_certainty(parameters: Mapping[str, Parameter]) -> list[tuple[str, Parameter]]:
    """Parameters of an effect, those that the records determine first."""
    return sorted(parameters.items(), key=lambda item: not is_determined(item[1]))


def describe_parameter(name: str, parameter: Parameter) -> str:
    """A parameter of an effect: its name, value, deviation and unit.

    Where the records do not determine it, this is said, with the fitted value if it is identifiable.
    """
    text = quantity(parameter.value, parameter.standard_deviation, parameter.unit)
    if not is_determined(parameter):
        return f"{plain_name(name)} {UNDETERMINED}" + (f": fitted {text}" if parameter.identifiable else "")
    more = ", at its bound" if parameter.at_bound else ""
    if parameter.standard_deviation and abs(parameter.value) < NEAR_ZERO_DEVIATIONS * parameter.standard_deviation:
        more += f", less than {NEAR_ZERO_DEVIATIONS:g} standard deviations from zero"
    return f"{plain_name(name)} {text}{more}"


def validation_tests(saved: DiagnosisFile) -> str:
    """Data on which the gain of an effect was found.

    These are tests that were held out, or blocks of the fitted tests left out in turn.
    """
    held = any(row.use == "holdout" for row in saved.augmented.error.values())
    return "held-out tests" if held else "blocks of the fitted tests left out in turn"


def verdict_sentence(saved: DiagnosisFile) -> str:
    """The verdict of a diagnosis in one sentence, for a project manager."""
    waves_in_doubt = any(effect.in_doubt == WAVE_ORDER for effect in saved.missing.effects)
    return f"{WAVES_FIRST} {verdict_of_effects(saved)}" if waves_in_doubt else verdict_of_effects(saved)


def verdict_of_effects(saved: DiagnosisFile) -> str:
    """What the model lacks, in one sentence."""
    missing = saved.missing
    named = [(effect_in_words(effect.effect, effect.degree_of_freedom), effect.in_doubt is None) for effect in missing.effects]
    names, doubted = (listed([name for name, sure in named if sure is kind]) for kind in (True, False))
    if not saved.complete and not named:
        return UNFINISHED
    if missing.verdict == Outcome.FOUND:
        more = f" {capitalised(doubted)} may stand for something else (see below)." if doubted else ""
        until = "" if saved.complete else " This is what was found until the search was stopped."
        return f"The model lacks {names}. {error_reduction(saved)}.{more}{until}"
    if not saved.converged and not named:
        return UNFINISHED
    if missing.verdict == Outcome.NOTHING_MISSING:
        return "These records show nothing that the model lacks: no effect that was tried survives."
    lacks = "The model lacks something, and no effect that was tried explains it"
    return f"{lacks}. {capitalised(doubted)} may stand for it. {error_reduction(saved)}." if doubted else f"{lacks}."


def error_reduction(saved: DiagnosisFile) -> str:
    """How much smaller errors are, of the held-out tests where there are any."""
    before, after = saved.baseline.objective, saved.augmented.objective
    many, doubted = len(saved.missing.effects) > 1, any(effect.in_doubt is not None for effect in saved.missing.effects)
    added = f"With {'all that was found' if many and doubted else 'them' if many else 'it'} in the model, the error"
    if before.holdout and after.holdout is not None:
        return f"{added} of tests that were not fitted {describe_change(before.holdout, after.holdout)}"
    sentence = f"{added} of the fitted tests {describe_change(before.fit, after.fit)}"
    checked = any(effect.evidence.holdout_gain is not None for effect in saved.missing.effects)
    return sentence if checked else f"{sentence}. No test was held out to check it"


def describe_change(before: float, after: float) -> str:
    """falls by 61 % (J from 0.57 to 0.22)"""
    if not before > 0:
        return f"is {number(after, 3)} (J)"
    share = 1 - after / before
    if abs(share) < 0.005:
        return f"stays as it was (J {number(before, 3)})"
    word = "falls" if share >= 0 else "grows"
    return f"{word} by {percent(abs(share))} (J from {number(before, 3)} to {number(after, 3)})"


def objectives_sentence(saved: DiagnosisFile) -> str:
    """Objective of the fitted and of the held-out tests, before and after the effects were added."""
    before, after = saved.baseline.objective, saved.augmented.objective
    sentence = f"The error of the fitted tests {describe_change(before.fit, after.fit)}"
    if before.holdout is not None and after.holdout is not None:
        sentence += f". That of the held-out tests {describe_change(before.holdout, after.holdout)}"
    return f"{sentence}."


def describe_probability(probability: float | None) -> str:
    """A probability in per cent, none of which is certain."""
    if probability is None:
        return "unknown"
    return "above 99 %" if probability > 0.99 else "below 1 %" if probability < 0.01 else f"{100 * probability:.0f} %"


def describe_range(effect: FoundEffect, name: str) -> str:
    """Plausible range of an effect's parameter."""
    size, parameter = effect.plausible.get(name), effect.parameters[name]
    shown = max(abs(parameter.value), parameter.standard_deviation or 0.0)
    return "" if size is None else quantity_range(size.lower, size.upper, parameter.unit, shown)


def describe_limit(limit: DetectionLimit) -> str:
    """The size from which an effect would have been named; a range where it depends on the shape of the effect."""
    if limit.smallest is None:
        return "no size"
    if limit.largest is None:
        return f"{quantity(limit.smallest, None, limit.unit)}, or not, by its shape"
    if limit.largest < SAME_LIMIT * limit.smallest:
        return quantity(limit.smallest, None, limit.unit)
    return f"{quantity_range(limit.smallest, limit.largest, limit.unit)}, by its shape"


def evidence_strength(evidence: Evidence) -> str:
    """The evidence's weight by BIC, in the words of Kass and Raftery."""
    if evidence.delta_bic is None:
        return "unknown"
    return next((word for limit, word in EVIDENCE_STRENGTHS if evidence.delta_bic > limit), "none")


def describe_certainty(saved: DiagnosisFile, effect: FoundEffect) -> list[str]:
    """How sure an effect is: sentences with their numbers."""
    evidence = effect.evidence
    sentences = []
    if evidence.probability is not None:
        many = len(saved.missing.effects) + len(saved.missing.rejected)
        sentences.append(
            f"Its probability is {describe_probability(evidence.probability)}, among {many} effects compared together."
        )
    if evidence.delta_bic is not None:
        fell = f"BIC falls by {number(evidence.delta_bic, 3)} (above 10 is very strong)"
        sentences.append(f"{evidence_strength(evidence).capitalize()} evidence on the fitted tests: {fell}.")
    gain = evidence.holdout_gain
    if gain is None:
        sentences.append("No test was held out to check it.")
    elif gain >= 0:
        sentences.append(f"The squared error of {validation_tests(saved)} falls by {percent(gain)} {WHERE}.")
    else:
        sentences.append(f"The squared error of {validation_tests(saved)} grows by {percent(-gain)}.")
    several = sum(row.use == "fit" for row in saved.augmented.error.values()) > 1  # else nothing is left to fit
    if several and evidence.left_out is not None and evidence.left_out_better is not None:
        better = f"{percent(evidence.left_out_better)} are predicted better with it"
        fell = f"−2 ln L falls by {number(evidence.left_out, 3)}"
        sentences.append(f"Of whole fitted tests left out in turn (linearised model), {better}; {fell}.")
    share = effect.share_of_residual_explained
    whole = share is not None and 0.99 < share < 1
    part = "more than 99 %" if whole else percent(share)
    sentences.append(f"It explains {part} of the squared error of all fitted tests above the noise.")
    if evidence.clear is not None:
        away = f"{number(evidence.clear, 2)} standard deviations from zero"
        sentences.append(f"All its parameters together are {away}." if len(effect.parameters) > 1 else f"Its size is {away}.")
    if evidence.score is not None:
        fell = f"−2 ln L fell by {number(evidence.score, 3)}"
        sentences.append(f"Its largest first-order gain in any round, beyond what the coefficients can explain: {fell}.")
    return sentences


def describe_unexplained(saved: DiagnosisFile) -> str:
    """Sentence on the part of the error that nothing explains."""
    residual = saved.missing.unexplained
    share = f"{percent(residual.share)} of the squared error above the noise, motion by motion, is left unexplained"
    if not residual.signature:
        return f"{share if saved.missing.effects else 'What is left'}."
    rest = f"What is left: {residual.signature.rstrip('.')}."
    return f"{share}. {rest}" if saved.missing.effects else rest
