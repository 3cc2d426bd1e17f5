"""Schema of a member in a RAFT design file, with RAFT's defaults.

Keys, shapes and defaults are those of RAFT at e6cb69e: raft_member.py, Member.__init__, and helpers.py, getFromDict. Other
keys are allowed.
"""

from collections.abc import Iterator
from typing import Annotated, Any, Literal

import numpy as np
from jaxtyping import Float
from pydantic import BeforeValidator, ConfigDict, Discriminator, Field, Tag

from jaxhydro.errors import Problem, shown
from jaxhydro.input_schema import Consistent, Flag, NonNegative, Number, Text, Vector

OPEN = ConfigDict(frozen=True, extra="allow")
Pair = tuple[Number, Number]


def _form(value: Any) -> str:
    if not isinstance(value, list | tuple):
        return "one"
    return "pairs" if value and isinstance(value[0], list | tuple) else "row"


Row = Annotated[
    Annotated[Number, Tag("one")] | Annotated[tuple[Number, ...], Tag("row")],
    Discriminator(lambda value: "row" if isinstance(value, list | tuple) else "one"),
]
Table = Annotated[
    Annotated[Number, Tag("one")] | Annotated[tuple[Number, ...], Tag("row")] | Annotated[tuple[Pair, ...], Tag("pairs")],
    Discriminator(_form),
]


def _shape(value: Any) -> Any:
    """RAFT takes the first letter; here it has to be the beginning of the word, too."""
    word = value.lower() if isinstance(value, str) and value else ""
    return next((short for whole, short in _SHAPES.items() if word and whole.startswith(word)), value)


_SHAPES = {"circular": "circ", "rectangular": "rect"}
Name = Annotated[Text, BeforeValidator(lambda value: str(value) if type(value) is int else value)]


class RaftMember(Consistent):
    """Member of a platform, a tower or a nacelle.

    Sizes are in m, densities in kg/m³, angles in degrees; `stations`, `l_fill` and `cap_stations` have one scale, which is
    stretched to the distance from rA to rB.
    """

    model_config = OPEN

    name: Name
    type: Any = "rigid"
    shape: Annotated[Literal["circ", "rect"], BeforeValidator(_shape)]
    rA: Vector
    rB: Vector
    stations: Annotated[tuple[Number, ...], Field(min_length=2)]
    d: Table
    t: Row = 0.0
    rho_shell: NonNegative = 8500.0
    l_fill: Row = 0.0
    rho_fill: Row = 1025.0
    cap_stations: tuple[Number, ...] = ()
    cap_t: Row = 0.0
    cap_d_in: Table = 0.0
    Ca: Table = 0.97
    Cd: Table = 0.6
    CaEnd: Row = 0.6
    CdEnd: Row = 0.6
    Ca_q: Row = 0.0
    Cd_q: Row = 0.0
    heading: Row = 0.0
    gamma: Number = 0.0
    potMod: Flag = False
    MCF: Flag = False

    @property
    def circular(self) -> bool:
        """Whether the section is a circle."""
        return self.shape == "circ"

    @property
    def length(self) -> float:
        """Distance from rA to rB, m."""
        return float(np.linalg.norm(np.subtract(self.rB, self.rA)))

    def along(self, station: Any) -> Any:
        """Distance from rA (m) of a station, or of several."""
        first, last = self.stations[0], self.stations[-1]
        return (np.asarray(station, float) - first) / (last - first) * self.length

    def per_station(self, key: str) -> Float[np.ndarray, " n"]:
        """A value at each station."""
        return np.broadcast_to(np.array(getattr(self, key), float), (len(self.stations),))

    def per_section(self, key: str) -> Float[np.ndarray, " m"]:
        """A value for each section between two stations."""
        return np.broadcast_to(np.array(getattr(self, key), float), (len(self.stations) - 1,))

    def sizes(self) -> Float[np.ndarray, "n 2"]:
        """The two sizes (m) at each station: a diameter twice, or two sides."""
        sizes = np.array(self.d, float)
        if self.circular:
            sizes = np.broadcast_to(sizes, (len(self.stations),))[:, None]
        return np.broadcast_to(sizes, (len(self.stations), 2))

    def cap_thicknesses(self) -> Float[np.ndarray, " c"]:
        """Thickness (m) of each cap.

        Without `cap_stations` there is none, whatever `cap_t` says, as in RAFT.
        """
        return np.broadcast_to(np.array(self.cap_t, float), (len(self.cap_stations),)) if self.cap_stations else np.zeros(0)

    def holes(self) -> Float[np.ndarray, "c 2"]:
        """The two sizes (m) of the hole in each cap."""
        if not self.cap_stations:
            return np.zeros((0, 2))
        holes = np.array(self.cap_d_in, float)
        if self.circular:
            holes = np.broadcast_to(holes, (len(self.cap_stations),))[:, None]
        return np.broadcast_to(holes, (len(self.cap_stations), 2))

    def directions(self, key: str) -> Float[np.ndarray, "2 n"]:
        """A transverse coefficient in RAFT's directions p1 and p2, at each station.

        A flat list is the two directions, whatever its length (RAFT, helpers.py, getFromDict with an index). So RAFT's code
        has it, though comments in its designs speak of stations. A list of pairs has a pair for each station.
        """
        value, n = np.array(getattr(self, key), float), len(self.stations)
        if value.ndim == 2:
            return value.T
        return np.repeat(np.broadcast_to(value[:2] if value.ndim else value, (2,))[:, None], n, axis=1)

    def _faults(self) -> Iterator[Problem]:
        n = len(self.stations)
        if self.rA == self.rB:
            yield Problem("rB", "an end B that is not end A", shown(self.rB))
            return
        apart = np.diff(self.stations)
        if (apart < 0).any() or apart[0] == 0 or apart[-1] == 0 or ((apart[1:] == 0) & (apart[:-1] == 0)).any():
            hint = "A step in size is one station twice, between the ends."
            yield Problem("stations", "numbers in ascending order", shown(self.stations), hint)
            return
        if problems := list(self._lengths(n)):
            yield from problems
        else:
            yield from self._sizes_that_fit()

    def _lengths(self, n: int) -> Iterator[Problem]:
        caps = len(self.cap_stations)
        for key, count, noun in (
            *((key, n, "stations") for key in ("t", "CaEnd", "CdEnd", "Ca_q", "Cd_q")),
            *((key, n - 1, "sections between stations") for key in ("l_fill", "rho_fill")),
            ("cap_t", caps, "cap_stations"),
        ):
            value = getattr(self, key)
            if isinstance(value, tuple) and len(value) != count and (caps or key != "cap_t"):
                yield Problem(key, f"a number, or {count} numbers for {count} {noun}", f"{len(value)} numbers")
        for key in ("Ca", "Cd"):
            value = getattr(self, key)
            if isinstance(value, tuple) and len(value) not in ((n,) if _form(value) == "pairs" else (2, n)):
                yield Problem(key, f"a number, two for two directions, or a pair for each of {n} stations", shown(value))
        for key, count in (("d", n), ("cap_d_in", caps)):
            value = getattr(self, key)
            if not self._of_a_section(value, count, key == "d") and (key == "d" or caps):
                unit = "a diameter" if self.circular else "two sides"
                yield Problem(key, f"{unit}, or {count} of these in a list", shown(value))

    def _of_a_section(self, value: Any, count: int, sides: bool) -> bool:
        """Whether a value is one size of the section, or a list of them.

        Args:
            value: The value.
            count: Number of sizes in a list.
            sides: Whether a rectangle has two sizes, not one.
        """
        form = _form(value)
        if form == "one":
            return self.circular or not sides
        if form == "row":
            return len(value) == (count if self.circular else 2)
        return not self.circular and len(value) == count

    def _sizes_that_fit(self) -> Iterator[Problem]:
        sizes, t = self.sizes(), self.per_station("t")
        if (sizes <= 0).any():
            yield Problem("d", "sizes > 0", shown(self.d))
        if (t < 0).any():
            yield Problem("t", "thicknesses >= 0", shown(self.t))
        elif (2 * t > sizes.min(axis=1) * (1 + 1e-9)).any():
            yield Problem("t", "thicknesses up to half the size of the section", shown(self.t))
        for i, (fill, section) in enumerate(zip(self.per_section("l_fill"), np.diff(self.stations))):
            if not 0 <= fill <= section * (1 + 1e-9):
                where = f"l_fill[{i}]" if isinstance(self.l_fill, tuple) else "l_fill"
                yield Problem(where, f"a fill between 0 and the length of its section, {section:g}", f"{fill:g}")
        for key in ("rho_fill", "Ca", "Cd", "CaEnd", "CdEnd", "cap_t", "cap_d_in"):
            if (np.array(getattr(self, key)) < 0).any():
                yield Problem(key, "numbers >= 0", shown(getattr(self, key)))
        for i, (station, cap) in enumerate(zip(self.cap_stations, self.cap_thicknesses())):
            low, high = cap_extent(self, i, float(cap))
            if low < -1e-9 * self.length or high > (1 + 1e-9) * self.length:
                yield Problem(f"cap_stations[{i}]", "a cap within the member", f"{station:g}, {cap:g} m thick")


def cap_extent(member: RaftMember, index: int, thickness: float) -> tuple[float, float]:
    """Where a cap begins and ends, m from rA.

    A cap at an end lies inside it. Of two caps at one station the first lies before it, the second after it. Any other cap
    has its station in the middle (RAFT at e6cb69e, raft_member.py, getInertia).
    """
    stations = member.cap_stations
    position, same = float(member.along(stations[index])), stations[index]
    if same == member.stations[0] or (index > 0 and stations[index - 1] == same and same != member.stations[-1]):
        return position, position + thickness
    if same == member.stations[-1] or (index + 1 < len(stations) and stations[index + 1] == same):
        return position - thickness, position
    return position - thickness / 2, position + thickness / 2
