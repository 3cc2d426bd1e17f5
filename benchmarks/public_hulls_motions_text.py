"""Sections on decays and the sea of the page of `benchmarks.public_hulls`."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any, NamedTuple

DECAY_GOAL, SEA_GOAL = 0.02, 0.05  # deviations that need no reason
SHOWN = ("surge", "heave", "pitch")
UNITS = {"surge": "m", "heave": "m", "pitch": "°"}
UNEXPLAINED = "not explained yet."


class Motion(NamedTuple):
    """A period of a decay or a standard deviation in the sea, beside what is expected.

    Attributes:
        quantity: Such as "heave decay" or "pitch sea".
        simulated: Value of the simulation.
        expected: Natural period, or by linear theory.
        goal: Deviation that needs no reason.
    """

    quantity: str
    simulated: float
    expected: float
    goal: float

    @property
    def deviation(self) -> float:
        """Relative deviation from what is expected."""
        return self.simulated / self.expected - 1

    def __str__(self) -> str:
        return f"{self.simulated:.4g} ({100 * self.deviation:+.1f} %)"


def periods(result: Mapping[str, Any]) -> dict[str, Motion]:
    """Decays of a hull that have a period and a natural period, by motion."""
    natural = result["statics"]["periods"]
    decays = result["motions"]["decays"]
    return {
        dof: Motion(f"{dof} decay", decays[dof]["period"], natural[dof], DECAY_GOAL)
        for dof in SHOWN
        if decays[dof]["period"] is not None and dof in natural
    }


def deviations(result: Mapping[str, Any]) -> dict[str, Motion]:
    """Standard deviations of a hull in the sea, by motion."""
    sea = result["motions"]["sea"]
    return (
        {} if sea is None else {dof: Motion(f"{dof} sea", sea["simulated"][dof], sea["linear"][dof], SEA_GOAL) for dof in SHOWN}
    )


def with_motions(hulls: Sequence[Mapping[str, Any]]) -> list[Mapping[str, Any]]:
    """Hulls whose decays and sea were simulated."""
    return [result for result in hulls if "motions" in result]


def motions_summary(hulls: Sequence[Mapping[str, Any]]) -> str:
    """Sentence on how many decays and seas are as expected."""
    moving = with_motions(hulls)
    decayed = [motion for result in moving for motion in periods(result).values()]
    waved = [motion for result in moving for motion in deviations(result).values()]
    close, met = (sum(abs(motion.deviation) <= motion.goal for motion in rows) for rows in (decayed, waved))
    return (
        f"{close} of {len(decayed)} decays have the natural period within {100 * DECAY_GOAL:g} %. "
        f"{met} of {len(waved)} standard deviations in a sea are those of linear theory within {100 * SEA_GOAL:g} %."
    )


def motion_sections(hulls: Mapping[str, Mapping[str, Any]], table: Callable[..., str]) -> Iterator[str]:
    """Sections on decays and the sea, by title of hull."""
    moving = {title: result for title, result in hulls.items() if "motions" in result}
    yield "## Decays: period (s), and its deviation from the natural period"
    yield table(
        ("Hull", *SHOWN),
        [(title, *(str(periods(result).get(dof, "-")) for dof in SHOWN)) for title, result in moving.items()],
    )
    yield (
        f"- Decays were run for {len(moving)} of {len(hulls)} hulls, 600 s each.\n"
        "- Released 5 m, 1 m and 3° from rest, in still water; the mean of up to six half cycles. The TLP is released 0.1 m "
        "and 0.1° from rest in heave and pitch.\n"
        "- A hull without a period in a motion has no restoring in it, or is damped too much."
    )
    yield "## Sea: standard deviations, and their deviation from linear theory"
    waved = {title: result for title, result in moving.items() if result["motions"]["sea"] is not None}
    head = ("Hull", *(f"{dof} ({UNITS[dof]})" for dof in SHOWN), "surge, all frequencies (m)", "mean surge (m)")
    yield table(
        head,
        [
            (
                title,
                *(str(motion) for motion in deviations(result).values()),
                *(f"{result['motions']['sea'][key]['surge']:.3g}" for key in ("all", "mean")),
            )
            for title, result in waved.items()
        ],
    )
    yield (
        f"- The sea was run for {len(waved)} of {len(hulls)} hulls.\n"
        "- JONSWAP, Hs 3 m, Tp 10 s, 3600 s, first order, waves along x; from 900 s on, at 0.05 to 0.3 Hz. A hull with little "
        "damping in surge still rings from the start, below these frequencies.\n"
        "- Linear theory: mass, stiffness and the tables' added mass, damping and wave forces, for the same wave components. "
        "Hulls without tables have the force on the held hull in waves of 0.1 mm.\n"
        "- Drag is linearised for its damping; its wave force is left out of linear theory."
    )


def motion_reasons(hulls: Sequence[tuple[str, Mapping[str, str], Mapping[str, Any]]]) -> Iterator[str]:
    """Reasons of the deviations of decays and seas, by hull.

    Args:
        hulls: Title, reasons by quantity, and results of each.
    """
    for title, reasons, result in hulls:
        if "motions" not in result:
            continue
        given: dict[str, list[str]] = {}
        for motion in (*periods(result).values(), *deviations(result).values()):
            if abs(motion.deviation) > motion.goal:
                text = f"{motion.quantity} {100 * motion.deviation:+.1f} %"
                given.setdefault(reasons.get(motion.quantity, UNEXPLAINED), []).append(text)
        for reason, what in given.items():
            yield f"- {title}: {', '.join(what)}: {reason}"
