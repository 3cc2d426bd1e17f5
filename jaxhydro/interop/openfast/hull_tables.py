"""HydroDyn's joints, members, property sets and fill groups.

References:
    OpenFAST v5.0.0 (2895884), HydroDyn_Input.f90 (columns), Morison.f90: FlipMemberNodeData, Morison_DirCosMtrx_Spin.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal, TypeVar

import numpy as np
from jaxtyping import Float

from jaxhydro.interop.openfast.keyed_file import KeyedFile
from jaxhydro.interop.openfast.table_row import TableRow, bare_word, to_number

JOINTS = {6: ["JointID", "Jointxi", "Jointyi", "Jointzi", "JointAxID", "JointOvrlp"]}
_AXIAL = ["AxCoefID", "AxCd", "AxCa", "AxCp", "AxFDMod", "AxVnCOff", "AxFDLoFSc"]
AXIAL = {4: _AXIAL[:4], 5: _AXIAL[:5], 7: _AXIAL}
CYLINDERS = {3: ["PropSetID", "PropD", "PropThck"]}
RECTANGLES = {4: ["PropSetID", "PropA", "PropB", "PropThck"]}
_ENDS = ["MemberID", "MJointID1", "MJointID2", "MPropSetID1", "MPropSetID2"]
_FILTER = ["FDMod", "VnCOffA", "VnCOffB", "FDLoFScA", "FDLoFScB"]
_MEMBERS = [*_ENDS, "MSecGeom", "MSpinOrient", "MDivSize", "MCoefMod", "MHstLMod", "PropPot"]
MEMBERS = {
    8: [*_ENDS, "MDivSize", "MCoefMod", "PropPot"],
    9: [*_ENDS, "MDivSize", "MCoefMod", "MHstLMod", "PropPot"],
    11: _MEMBERS,
    16: [*_MEMBERS, *_FILTER],
}
RECTANGULAR = 2  # MSecGeom
Row = TypeVar("Row")


@dataclass(frozen=True)
class Joint:
    """A joint.

    Attributes:
        number: JointID.
        position: From the origin at still water, m.
        axial: Its row of the axial coefficients.
    """

    number: int
    position: Float[np.ndarray, "3"]
    axial: TableRow


@dataclass(frozen=True)
class HydroDynMember:
    """A member, with its lower end first as in HydroDyn.

    Attributes:
        number: MemberID.
        joints: Joints at its ends.
        shape: Circle or rectangle.
        sizes: Diameter twice, or PropA and PropB, at both ends, m, (2, 2).
        walls: PropThck at both ends, m, (2,).
        spin: Of a rectangle about the axis from the first end to the second, deg.
        model: MCoefMod.
        flipped: Whether the file has the ends the other way around.
        potential: Whether potential flow stands for it.
        row: Its row.
    """

    number: int
    joints: tuple[Joint, Joint]
    shape: Literal["circ", "rect"]
    sizes: Float[np.ndarray, "2 2"]
    walls: Float[np.ndarray, "2"]
    spin: float
    model: int
    flipped: bool
    potential: bool
    row: TableRow


@dataclass(frozen=True)
class FillGroup:
    """Ballast of the same density in members.

    Attributes:
        members: Their MemberID.
        surface: Height of its free surface above still water, m.
        density: kg/m3.
    """

    members: tuple[int, ...]
    surface: float
    density: float


def read_joints(file: KeyedFile, level: float) -> dict[int, Joint]:
    """Joints by number.

    Args:
        file: HydroDyn's file.
        level: Still water above mean sea level, m.

    Raises:
        InputError: A table is broken, or a joint names axial coefficients that are not there.
    """
    axial = {row.whole("AxCoefID"): row for row in file.table(("NAxCoef", "NAxCoefs"), AXIAL)}
    joints = {}
    for row in file.table("NJoints", JOINTS):
        number = row.whole("JointID")
        position = np.array([row.number(f"Joint{axis}i") for axis in "xyz"]) - [0.0, 0.0, level]
        if number in joints:
            raise row.wrong("each JointID once", f"{number} again")
        joints[number] = Joint(number, position, _of(axial, row, "JointAxID", "AxCoefID"))
    return joints


def read_members(file: KeyedFile, joints: dict[int, Joint]) -> list[HydroDynMember]:
    """Members of HydroDyn's file.

    Raises:
        InputError: The table is broken, or a member names a joint or a property set that is not there.
    """
    circles = {row.whole("PropSetID"): row for row in file.table(("NPropSetsCyl", "NPropSets"), CYLINDERS)}
    boxes = {row.whole("PropSetID"): row for row in file.table("NPropSetsRec", RECTANGLES)}
    members, numbers = [], set()
    for row in file.table("NMembers", MEMBERS):
        if (number := row.whole("MemberID")) in numbers:
            raise row.wrong("each MemberID once", f"{number} again")
        numbers.add(number)
        rectangular = row.whole("MSecGeom", 1) == RECTANGULAR
        sections = boxes if rectangular else circles
        ends = [_of(joints, row, f"MJointID{i}", "JointID") for i in (1, 2)]
        walls = [_of(sections, row, f"MPropSetID{i}", "PropSetID") for i in (1, 2)]
        sizes = [[wall.number(key) for key in (("PropA", "PropB") if rectangular else ("PropD", "PropD"))] for wall in walls]
        if min(map(min, sizes)) <= 0.0:
            raise row.wrong("property sets of a size > 0", f"{min(map(min, sizes)):g} m")
        if ends[0].position.tolist() == ends[1].position.tolist():
            raise row.wrong("two joints at two places", f"{ends[0].number} and {ends[1].number} at one")
        spin, flipped = row.number("MSpinOrient", 0.0), bool(ends[0].position[2] > ends[1].position[2])
        step = -1 if flipped else 1
        member = HydroDynMember(
            number,
            (ends[::step][0], ends[::step][1]),
            "rect" if rectangular else "circ",
            np.array(sizes[::step]),
            np.array([wall.number("PropThck") for wall in walls[::step]]),
            step * spin if rectangular else 0.0,
            row.whole("MCoefMod"),
            flipped,
            row.flag("PropPot"),
            row,
        )
        members.append(member)
    return members


def read_fill_groups(file: KeyedFile, level: float, density: float, members: list[HydroDynMember]) -> list[FillGroup]:
    """Fill groups.

    Args:
        file: HydroDyn's file.
        level: Still water above mean sea level, m.
        density: Of the water, which FillDens DEFAULT means, kg/m3.
        members: The members.

    Raises:
        InputError: The table is broken, or a group names a member that is not there.
    """
    groups, member_numbers = [], {member.number for member in members}
    for index, words in file.word_rows("NFillGroups"):
        count = to_number(words[0])
        numbers = [to_number(word) for word in words[1:]]
        expected = "FillNumM, as many numbers of members, FillFSLoc and FillDens"
        if count != count // 1 or count < 1 or len(words) < count + 3:
            raise file.wrong(index, expected, f"{len(words)} words")
        listed, surface, last = numbers[: int(count)], numbers[int(count)], bare_word(words[int(count) + 2])
        if missing := [number for number in listed if number not in member_numbers]:
            raise file.wrong(index, "members of the table of members", f"{missing[0]:g}")
        fill_density = density if last.lower() == "default" else to_number(last)
        if not np.isfinite([surface, fill_density]).all() or fill_density < 0.0:
            raise file.wrong(index, expected, f"{words[int(count) + 1]} {last}")
        groups.append(FillGroup(tuple(map(int, listed)), surface - level, fill_density))
    return groups


def _of(rows: Mapping[int, Row], row: TableRow, column: str, identifier: str) -> Row:
    if (number := row.whole(column)) not in rows:
        listed = ", ".join(map(str, list(rows)[:20])) or "none"
        raise row.wrong(f"{column}: a {identifier} of the file ({listed})", f"{number}")
    return rows[number]
