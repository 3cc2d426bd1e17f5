"""Tables and a sentence on laws over the sea state."""

from collections.abc import Iterator

from calibration.fitting.law_choice import SeaLaws
from calibration.formatting import number, percent, with_deviation
from calibration.vocabulary import LAW_NAMES, Rows
from jaxhydro.waves.sea_state import SeaState


def laws_table(sea_laws: SeaLaws) -> Rows:
    """Errors of every law, the chosen one marked."""
    rows = [
        (
            LAW_NAMES[law.name],
            str(len(law.added())),
            number(law.fitted, 3),
            number(law.held_out, 3),
            "chosen" if law is sea_laws.chosen else "",
        )
        for law in sea_laws.laws
    ]
    judged = "left out in turn" if sea_laws.left_out else "held out"
    return ("Coefficients", "Added", "Error, fitted", f"Error, {judged}", ""), rows


def states_table(sea_laws: SeaLaws) -> Rows:
    """Coefficients of every sea alone, and by the chosen law."""

    def cells(label: str) -> Iterator[str]:
        for sea in sea_laws.seas:
            parameter = sea.calibration.parameters[label]
            value, deviation = sea_laws.chosen.coefficient(label, sea.state)
            alone = (
                with_deviation(parameter.value, parameter.standard_deviation)
                if parameter.identifiable
                else f"({number(parameter.value, 2)})"
            )
            yield f"{alone} | {number(value, 3)} ± {percent(deviation)}"

    heads = [f"{sea.id}: {state_words(sea.state)}" for sea in sea_laws.seas]
    return ("Coefficient", *heads), [(label, *cells(label)) for label in sea_laws.labels()]


def state_words(state: SeaState) -> str:
    """In figures: Hs 2.7 m, Tp 9 s."""
    return f"Hs {number(state.significant_height, 2)} m, Tp {number(state.peak_period, 3)} s"


def sentence(sea_laws: SeaLaws) -> str:
    """Which law, and what it gains."""
    chosen, plain = sea_laws.chosen, sea_laws.laws[0]
    if not sea_laws.finished:
        tried = ", ".join(LAW_NAMES[law.name] for law in sea_laws.laws)
        return f"Stopped by the user: of {tried} the best is {LAW_NAMES[chosen.name]}"
    by = f"{', '.join(sea_laws.judged_by)} {'left out in turn' if sea_laws.left_out else 'held out'}"
    if chosen is plain:
        return f"No law does better than {LAW_NAMES[plain.name]} coefficients on {by} (error {number(plain.held_out, 3)})"
    gain = f"error {number(plain.held_out, 3)} of {LAW_NAMES[plain.name]} coefficients to {number(chosen.held_out, 3)}"
    return f"Chosen by {by}: {LAW_NAMES[chosen.name]}, {gain}"
