"""What an effect that was found could be instead, in words."""

from calibration.discovery.effects.effect_names import capitalised, effect_in_words
from calibration.discovery.reported_effects import HELD_OUT_ERROR, IMPLAUSIBLE_SIZE, WAVE_ORDER
from calibration.formatting import listed, number, percent
from calibration.report.diagnosis_words import (
    describe_parameter,
    describe_probability,
    describe_range,
    evidence_strength,
    plain_name,
    sorted_by_certainty,
    validation_tests,
)
from calibration.results.diagnosis_file import DiagnosisFile, FoundEffect


def describe_trades(effect: FoundEffect) -> str:
    """Other effects found whose sizes trade against an effect's."""
    others = [
        f"{effect_in_words(name)} (correlation {number(correlation, 2)})" for name, correlation in effect.trades_against.items()
    ]
    if not others:
        return ""
    return f"Its size trades against that of {listed(others)}: the records determine what they do together."


def describe_alternatives(effect: FoundEffect) -> str:
    """Other effects that it could be, and the test that would tell."""
    names = listed([effect_in_words(other) for other in effect.indistinguishable_from])
    text = f"These records cannot tell it from {names}." if names else ""
    if effect.in_doubt == WAVE_ORDER:
        text += (
            " The model is driven with the second-order waves of theory, and the wave records lack them. This effect goes with "
            "the square of the waves as well, and may make up for them."
        )
    elif effect.in_doubt == HELD_OUT_ERROR:
        text += (
            " With all that was found in the model, the tests that were not fitted are followed worse, altogether or in this "
            "motion. It may stand for something else."
        )
    elif effect.in_doubt == IMPLAUSIBLE_SIZE:
        ends = [
            f"{plain_name(name)}, plausible from {describe_range(effect, name)} ({size.source.rstrip('.')})"
            for name, size in effect.plausible.items()
            if size.at_end
        ]
        text += (
            f" The fitted size is at the end of what is plausible: {'; '.join(ends)}. Something acts like it, and is not, or "
            "not only, this."
        )
    elif effect.in_doubt is not None:
        text += (
            f" {capitalised(effect_in_words(effect.in_doubt))} explains more of the fitted tests beside it than it does, and "
            "is refused (see what was rejected). It may stand for something that neither is."
        )
    elif not names and effect.evidence.score is not None:
        text = "No other effect that was tried does as well."
    text = f"{text} {describe_trades(effect)}"
    if effect.test_that_would_tell:
        text += f" A test that would tell: {effect.test_that_would_tell.rstrip('.')}."
    return text.strip()


def effect_in_three_lines(saved: DiagnosisFile, effect: FoundEffect) -> tuple[str, str, str]:
    """Name and size of an effect; how sure it is; what else it could be, with the test that would tell."""
    name = capitalised(effect_in_words(effect.effect, effect.degree_of_freedom))
    sizes = "; ".join(describe_parameter(*item) for item in sorted_by_certainty(effect.parameters))
    evidence, gain = effect.evidence, effect.evidence.holdout_gain
    certainty = [f"probability {describe_probability(evidence.probability)}"]
    if gain is None:
        certainty.append("no test was held out to check it")
    else:
        changes = f"falls by {percent(gain)} where it falls most" if gain >= 0 else f"grows by {percent(-gain)}"
        certainty.append(f"squared error of {validation_tests(saved)} {changes}")
    certainty.append(f"{evidence_strength(evidence)} evidence on the fitted tests")
    against = describe_alternatives(effect) or "Nothing else that was tried does as well."
    return f"{name}: {sizes}" if sizes else name, f"  How sure: {'; '.join(certainty)}.", f"  What else it could be: {against}"
