"""Sea states of a sweep as plain values: a wind sea, or a wind sea with a swell."""

from collections.abc import Iterator, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from jaxhydro.errors import Problem, shown
from jaxhydro.waves.directional_spectrum import WaveSystem

OF_SWELL = ("swell_hs", "swell_tp", "swell_gamma", "swell_heading", "swell_spreading")
UNITS = {"hs": "m", "tp": "s", "spreading": "1", "swell_hs": "m", "swell_tp": "s", "swell_heading": "deg"}
UNITS |= {"swell_gamma": "1", "swell_spreading": "1"}  # of the fields of `State`, but for gamma


class State(NamedTuple):
    """Sea state, without the direction of its wind sea.

    Attributes:
        hs: Significant wave height of the wind sea (m).
        tp: Its peak period (s).
        gamma: Its peak enhancement (-); None: IEC's, or not a JONSWAP spectrum.
        spreading: Its exponent s (-); None: that of the sweep.
        swell_hs: Significant wave height of the swell (m); None: no swell.
        swell_tp: Peak period of the swell (s).
        swell_gamma: Peak enhancement of the swell (-), as `gamma`.
        swell_heading: Direction that the swell travels to (deg); None: that of the wind sea.
        swell_spreading: Exponent s of the swell (-); None: long-crested.
    """

    hs: float
    tp: float
    gamma: float | None = None
    spreading: float | None = None
    swell_hs: float | None = None
    swell_tp: float | None = None
    swell_gamma: float | None = None
    swell_heading: float | None = None
    swell_spreading: float | None = None

    @classmethod
    def of(cls, source: Any) -> "State":
        """Sea state from an object that has its fields as attributes."""
        return cls(*(getattr(source, name) for name in cls._fields))

    @property
    def height(self) -> float:
        """Significant wave height of the whole sea (m)."""
        return self.hs if self.swell_hs is None else float(np.hypot(self.hs, self.swell_hs))

    @property
    def peaks(self) -> list[tuple[float, float]]:
        """Significant wave height (m) and peak period (s) of each system."""
        swell = [] if self.swell_hs is None or self.swell_tp is None else [(self.swell_hs, self.swell_tp)]
        return [(self.hs, self.tp), *swell]

    @property
    def peak_period(self) -> float:
        """Peak period (s) of the highest system, as `RequestedSea.of_systems` has it."""
        return max(self.peaks, key=lambda peak: peak[0])[1]

    def systems(self, heading: float, spectrum: str, spreading: float | None) -> tuple[WaveSystem, ...]:
        """Wave systems of the sea state: the wind sea, and the swell if there is one.

        Args:
            heading: Direction that the wind sea travels to (deg).
            spectrum: Spectrum of both systems, as `WaveSystem` has it.
            spreading: Exponent s (-) of a wind sea without its own; None: long-crested.
        """
        exponent = spreading if self.spreading is None else self.spreading
        sea = WaveSystem(self.hs, self.tp, self.gamma, heading, exponent, spectrum)
        if self.swell_hs is None or self.swell_tp is None:
            return (sea,)
        towards = heading if self.swell_heading is None else self.swell_heading
        return sea, WaveSystem(self.swell_hs, self.swell_tp, self.swell_gamma, towards, self.swell_spreading, spectrum)


def swell_problems(values: Mapping[str, Any]) -> Iterator[Problem]:
    """Mistakes in the swell of a sea state.

    Args:
        values: Values of the sea state that are stated, by name.
    """
    stated = [name for name in OF_SWELL if values.get(name) is not None]
    for name in OF_SWELL[:2]:
        if stated and name not in stated:
            yield Problem(name, f"a number > 0, for a swell with {stated[0]}", "nothing")


def named(state: State) -> str:
    """Sea state in words."""
    words = f"Hs {state.hs:g} m, Tp {state.tp:g} s" + ("" if state.gamma is None else f", gamma {state.gamma:g}")
    words += "" if state.spreading is None else f", spreading {state.spreading:g}"
    if state.swell_hs is None:
        return words
    words += f", swell Hs {state.swell_hs:g} m, Tp {state.swell_tp:g} s"
    words += "" if state.swell_gamma is None else f", gamma {state.swell_gamma:g}"
    words += "" if state.swell_heading is None else f" towards {state.swell_heading:g} deg"
    return words + ("" if state.swell_spreading is None else f", spreading {state.swell_spreading:g}")


def runs_in_words(state: State, headings: Sequence[float], seeds: Sequence[int]) -> str:
    """Runs of one sea state in words."""
    towards = f"heading {headings[0]:g} deg" if len(headings) == 1 else f"{len(headings)} headings"
    drawn = f"seed {seeds[0]}" if len(seeds) == 1 else f"{len(seeds)} seeds"
    return f"{named(state)}, {towards}, {drawn}"


def table_problems(rows: Sequence[Any], spectrum: str, order: int, headings: Sequence[float] | None) -> Iterator[Problem]:
    """Mistakes in the sea states of a sweep; `where` begins with the row's number in brackets.

    Args:
        rows: Sea states of the table (`SeaState`).
        spectrum: Spectrum of the sweep.
        order: 1 or 2.
        headings: Headings that the sweep states (deg); None: none.
    """
    has_heading = [row.heading is not None for row in rows]
    for i, row in enumerate(rows):
        if spectrum != "jonswap":
            for key in ("gamma", "swell_gamma"):
                if getattr(row, key) is not None:
                    yield Problem(f"[{i}].{key}", "a JONSWAP spectrum with it", spectrum)
        if has_heading[i] and headings is not None:
            yield Problem(f"[{i}].heading", "none, since the sweep has headings for all sea states", shown(row.heading))
        elif any(has_heading) and not has_heading[i]:
            yield Problem(f"[{i}].heading", "a heading, as others in the table have", "none")
        towards = [row.heading] if has_heading[i] else list(headings or (0.0,))
        turned = row.swell_heading is not None and any((row.swell_heading - heading) % 360 for heading in towards)
        if order == 2 and (row.spreading is not None or row.swell_spreading is not None or turned):
            key = next(name for name in ("spreading", "swell_spreading", "swell_heading") if getattr(row, name) is not None)
            yield Problem(f"[{i}].{key}", "order: 1 with it: second order is of long-crested seas", f"order: {order}")
