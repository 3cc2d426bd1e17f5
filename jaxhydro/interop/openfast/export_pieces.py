"""Members as HydroDyn has them: tapering evenly between two joints, the lower joint first.

References:
    OpenFAST v5.0.0 (2895884), Morison.f90: FlipMemberNodeData, Morison_DirCosMtrx_Spin (an axis the other way around turns the
    spin around), and the sum of end areas and volumes at a joint (An, Vn). `hull.ends` has the same ring where two meet.
"""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from jaxtyping import Float

from jaxhydro.hull.member import Member

STEP = 1e-5  # of a member's length: stations that are closer are a step in size
MEETING = 1e-3  # of the larger radius: columns whose ends are closer meet (`hull.ends`)
ALIGNED = 1 - 1e-6
OVER_SEABED = 1e-3  # m


@dataclass(frozen=True)
class Piece:
    """Part of a member between two joints.

    Attributes:
        number: MemberID.
        member: The member that it is of.
        ends: Lower and upper end, m, (2, 3).
        sizes: Extents along both directions at the ends, m, (2, 2).
        spin: Rotation of the directions about the axis from the lower to the upper end, deg.
    """

    number: int
    member: Member
    ends: Float[np.ndarray, "2 3"]
    sizes: Float[np.ndarray, "2 2"]
    spin: float

    @property
    def axis(self) -> Float[np.ndarray, "3"]:
        """Unit vector from the lower to the upper end."""
        along = self.ends[1] - self.ends[0]
        return along / np.linalg.norm(along)

    @property
    def length(self) -> float:
        """Length, m."""
        return float(np.linalg.norm(self.ends[1] - self.ends[0]))

    @property
    def tapers(self) -> bool:
        """Whether its size changes along it."""
        return bool(np.ptp(self.sizes, axis=0).any())

    def area(self, end: int) -> float:
        """Area of the section at an end, m2."""
        return float(self.member.area(self.sizes[end]))

    def radius(self, end: int) -> float:
        """Radius of the circle of equal section at an end, m."""
        return math.sqrt(self.area(end) / math.pi)


@dataclass
class PieceJoint:
    """A joint of the deck.

    Attributes:
        number: JointID.
        position: m, (3,).
        meeting: Pieces that meet there, each with its end, 0 or 1.
    """

    number: int
    position: Float[np.ndarray, "3"]
    meeting: list[tuple[Piece, int]]

    def largest(self) -> tuple[Piece, int]:
        """The piece with the largest section there, whose coefficients the joint has, and its end."""
        return max(self.meeting, key=lambda pair: pair[0].area(pair[1]))


def pieces_of(members: Sequence[Member], depth: float) -> list[Piece]:
    """Members cut at their stations.

    Args:
        members: The members.
        depth: Water depth, m. Ends on the seabed are `OVER_SEABED` above it, as SeaState has no water below it.
    """
    pieces: list[Piece] = []
    for member in members:
        for low, high, sizes in _spans(member):
            ends = np.stack([member.a + fraction * (member.b - member.a) for fraction in (low, high)])
            if ends[0][2] > ends[1][2]:
                ends, sizes = ends[::-1], sizes[::-1]
            ends[:, 2] = np.where(np.abs(ends[:, 2] + depth) < OVER_SEABED, OVER_SEABED - depth, ends[:, 2])
            ends = np.where(np.abs(ends) < 1e-12 * np.abs(ends).max(), 0.0, ends)
            turned = float(member.axis @ (ends[1] - ends[0])) < 0.0
            spin = 0.0 if member.circular else math.degrees(-member.twist if turned else member.twist)
            pieces.append(Piece(len(pieces) + 1, member, ends, sizes, spin))
    return pieces


def all_at_surface(members: Sequence[Member]) -> bool:
    """Whether still water cuts all members lengthwise, as a barge.

    HydroDyn loads the whole section of nodes under water, and no others. Their added mass comes and goes with a node's height,
    and OpenFAST then does not converge.
    """
    return bool(members) and all(member.floats for member in members)


def _spans(member: Member) -> Iterator[tuple[float, float, Float[np.ndarray, "2 2"]]]:
    """First and last fraction of the length, and sizes (m) there, of each part between stations.

    The short taper of a step in size is left out.
    """
    stations, sizes = np.asarray(member.stations, float), np.asarray(member.sizes, float)
    steps = np.flatnonzero(np.diff(stations) < STEP).tolist()
    places = stations.copy()
    for i in steps:
        places[i : i + 2] = 0.5 * (stations[i] + stations[i + 1])
    for i, (low, high) in enumerate(pairwise(places)):
        if i not in steps:
            yield float(low), float(high), sizes[i : i + 2]


def joints_of(pieces: Sequence[Piece]) -> tuple[list[PieceJoint], dict[tuple[int, int], int]]:
    """Joints, and the number of the joint at each piece's ends.

    Every end has a joint of its own, as HydroDyn adds the areas at a joint as vectors. Columns that meet on one axis share one.

    Args:
        pieces: The pieces.
    """
    joints: list[PieceJoint] = []
    number: dict[tuple[int, int], int] = {}
    for piece in pieces:
        for end in (0, 1):
            joint = next((joint for joint in joints if _meets(joint, piece, end)), None)
            if joint is None:
                joint = PieceJoint(len(joints) + 1, piece.ends[end], [])
                joints.append(joint)
            joint.meeting.append((piece, end))
            number[piece.number, end] = joint.number
    return joints, number


def _meets(joint: PieceJoint, piece: Piece, end: int) -> bool:
    other, other_end = joint.meeting[0]
    if not (piece.member.column and other.member.column) or len(joint.meeting) > 1 or other_end == end:
        return False
    near = np.linalg.norm(joint.position - piece.ends[end]) < MEETING * max(piece.radius(end), other.radius(other_end))
    return bool(near and piece.axis @ other.axis > ALIGNED)
