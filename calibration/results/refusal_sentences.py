"""Sentences on why an effect is not in the model."""

from calibration.discovery.acceptance import MIN_FLOOR_MULTIPLE, MIN_MOTION_SHARE
from calibration.discovery.refusal import ComparedData, Refusal, RefusalKind

MIN_SHOWN_PROBABILITY = 0.005  # that is printed as a number
COMPARED = {
    ComparedData.FITTED: "fitted tests",
    ComparedData.HELD_OUT: "held-out tests",
    ComparedData.BLOCKS: "blocks left out in turn",
}


def describe_refusal(refusal: Refusal) -> str:
    """Reason why an effect is not in the model, in words."""
    values, where = refusal.values, COMPARED.get(refusal.compared, "all tests")
    match refusal.kind:
        case RefusalKind.IMPOSSIBLE_VALUE:
            return f"{refusal.name} comes out as {values[0]:.3g}, which physics does not allow"
        case RefusalKind.LITTLE_BIC_GAIN:
            told = refusal.compared == ComparedData.HELD_OUT
            asked = f"{values[1]:.0f} are asked" + ("" if told else " where nothing held out can tell")
            return f"it gains too little in the fitted tests (BIC {values[0]:+.0f}, {asked})"
        case RefusalKind.HELD_OUT_ERROR:
            percent = 100 * values[0]
            return f"the squared error of the {where} " + (
                f"falls by {percent:.0f} % only" if percent >= 0 else f"grows by {-percent:.0f} %"
            )
        case RefusalKind.HELD_OUT_LIKELIHOOD:
            return f"all in all the {where} do not gain by it (-2 ln L {-values[0]:+.0f})"
        case RefusalKind.LITTLE_TOTAL_GAIN:
            gains = f"BIC {values[0]:+.0f}, -2 ln L {-values[1]:+.0f}"
            return f"it gains too little in fitted and held-out tests together ({gains})"
        case RefusalKind.INSIGNIFICANT:
            return f"its parameters are no more than {values[0]:.1f} standard deviations from none"
        case RefusalKind.NEGLIGIBLE:
            least = f"{100 * MIN_MOTION_SHARE:.1f} % of the motion"
            return f"no error falls by {least}, nor by {MIN_FLOOR_MULTIPLE:.0f} times what can be seen"
        case RefusalKind.WORSE_MOTION:
            subject, objective = (f"{refusal.name} is", "J of it") if refusal.name else ("what moves is", "J")
            tests = where if refusal.compared == ComparedData.ALL else f"the {where}"
            change = f"{values[0]:.3f} without it, {values[1]:.3f} with it"
            return f"{subject} followed worse with it ({objective} in {tests}: {change})"
        case RefusalKind.WORSE_TEST:
            shares = f"{100 * values[1]:.1f} % of the motion is left with it, {100 * values[0]:.1f} % in the baseline"
            return f"{refusal.name} is followed worse with it ({shares})"
        case RefusalKind.UNSETTLED:
            return f"not settled: {100 * values[0]:.0f} % probable at the end, but most rounds or a smaller set do without it"
        case RefusalKind.IMPROBABLE:
            probability = f"{100 * values[0]:.0f} %" if values[0] >= MIN_SHOWN_PROBABILITY else "below 1 %"
            return f"improbable ({probability})"
