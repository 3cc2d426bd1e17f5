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
        found: Of the simulation.
        expected: Natural period, or by linear theory.
        goal: Deviation that needs no reason.
    """

    quantity: str
    found: float
    expected: float
    goal: float

    @property
    def deviation(self) -> float:
        """Relative deviation from what is expected."""
        return self.found / self.expected - 1

    def __str__(self) -> str:
        return f"{self.found:.4g} ({100 * self.deviation:+.1f} %)"


def periods(found: Mapping[str, Any]) -> dict[str, Motion]:
    """Decays of a hull that have a period and a natural period, by motion."""
    natural = found["statics"]["periods"]
    decays = found["motions"]["decays"]
    return {
        dof: Motion(f"{dof} decay", decays[dof]["period"], natural[dof], DECAY_GOAL)
        for dof in SHOWN
        if decays[dof]["period"] is not None and dof in natural
    }


def deviations(found: Mapping[str, Any]) -> dict[str, Motion]:
    """Standard deviations of a hull in the sea, by motion."""
    sea = found["motions"]["sea"]
    return (
        {} if sea is None else {dof: Motion(f"{dof} sea", sea["simulated"][dof], sea["linear"][dof], SEA_GOAL) for dof in SHOWN}
    )


def with_motions(hulls: Sequence[Mapping[str, Any]]) -> list[Mapping[str, Any]]:
    """Hulls whose decays and sea were simulated."""
    return [found for found in hulls if "motions" in found]


def motions_summary(hulls: Sequence[Mapping[str, Any]]) -> str:
    """Sentence on how many decays and seas are as expected."""
    moving = with_motions(hulls)
    decayed = [one for found in moving for one in periods(found).values()]
    waved = [one for found in moving for one in deviations(found).values()]
    close, met = (sum(abs(one.deviation) <= one.goal for one in rows) for rows in (decayed, waved))
    return (
        f"{close} of {len(decayed)} decays have the natural period within {100 * DECAY_GOAL:g} %. "
        f"{met} of {len(waved)} standard deviations in a sea are those of linear theory within {100 * SEA_GOAL:g} %."
    )


def motion_sections(hulls: Mapping[str, Mapping[str, Any]], table: Callable[..., str]) -> Iterator[str]:
    """Sections on decays and the sea, by title of hull."""
    moving = {title: found for title, found in hulls.items() if "motions" in found}
    yield "## Decays: period (s), and its deviation from the natural period"
    yield table(
        ("Hull", *SHOWN),
        [(title, *(str(periods(found).get(dof, "-")) for dof in SHOWN)) for title, found in moving.items()],
    )
    yield (
        f"- Decays were run for {len(moving)} of {len(hulls)} hulls, 600 s each.\n"
        "- Released 5 m, 1 m and 3° from rest, in still water; the mean of up to six half cycles. The TLP is released 0.1 m "
        "and 0.1° from rest in heave and pitch.\n"
        "- A hull without a period in a motion has no restoring in it, or is damped too much."
    )
    yield "## Sea: standard deviations, and their deviation from linear theory"
    waved = {title: found for title, found in moving.items() if found["motions"]["sea"] is not None}
    head = ("Hull", *(f"{dof} ({UNITS[dof]})" for dof in SHOWN), "surge, all frequencies (m)", "mean surge (m)")
    yield table(
        head,
        [
            (
                title,
                *(str(one) for one in deviations(found).values()),
                *(f"{found['motions']['sea'][key]['surge']:.3g}" for key in ("all", "mean")),
            )
            for title, found in waved.items()
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
    for title, reasons, found in hulls:
        if "motions" not in found:
            continue
        given: dict[str, list[str]] = {}
        for one in (*periods(found).values(), *deviations(found).values()):
            if abs(one.deviation) > one.goal:
                text = f"{one.quantity} {100 * one.deviation:+.1f} %"
                given.setdefault(reasons.get(one.quantity, UNEXPLAINED), []).append(text)
        for reason, what in given.items():
            yield f"- {title}: {', '.join(what)}: {reason}"
