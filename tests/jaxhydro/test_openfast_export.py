"""A platform as an OpenFAST deck, and back by the reader of decks."""

from pathlib import Path
from typing import NamedTuple

import jax
import numpy as np
import pytest
from one_program import one_program
from openfast_io.FAST_reader import InputReader_OpenFAST

from jaxhydro.cli.export_command import source_of
from jaxhydro.dynamics.model import Model
from jaxhydro.hull.member import Member
from jaxhydro.interop.conversion import Conversion, Treatment
from jaxhydro.interop.export_source import ExportedModel
from jaxhydro.interop.openfast.export_deck import export_deck
from jaxhydro.interop.openfast_deck import read_openfast_deck
from jaxhydro.loads import Buoyancy, EndInertia, QuadraticDamping
from jaxhydro.loads.static_force import StaticForce
from jaxhydro.platform.build import build
from jaxhydro.platform.catenary_schema import Catenary
from jaxhydro.platform.members_build import members_of
from jaxhydro.platform.mooring_schema import StiffnessMatrix
from jaxhydro.platform.schema import Platform, load_platform
from jaxhydro.rotations import rotation

BUILT_IN = ("volturnus-s", "oc3-hywind", "oc4-deepcwind", "iti-barge")
SAME = 1e-9
KEY_OFFSET = 0.0032  # m: keeps coordinates such as 1.625 m off the halves where rounding jumps


class RoundTrip(NamedTuple):
    """A platform, its deck, and the platform that the deck is read as."""

    before: Platform
    deck: ExportedModel
    folder: Path
    read: Conversion
    after: Platform


def round_trip(platform: Platform, folder: Path) -> RoundTrip:
    folder.mkdir(parents=True, exist_ok=True)
    deck = export_deck(source_of(platform, build(platform)))
    for name, text in deck.texts.items():
        (folder / name).write_text(text, encoding="utf-8")
    read = read_openfast_deck(folder / "main.fst")
    after = Platform.model_validate(read.platform)
    if after.hydrostatics.file:
        path = str(folder / after.hydrostatics.file)
        after = after.model_copy(update={"hydrostatics": after.hydrostatics.model_copy(update={"file": path})})
    return RoundTrip(platform, deck, folder, read, after)


@pytest.fixture(scope="module")
def trips(tmp_path_factory: pytest.TempPathFactory) -> dict[str, RoundTrip]:
    folder = tmp_path_factory.mktemp("decks")
    return {name: round_trip(load_platform(name), folder / name) for name in BUILT_IN}


def said(deck: ExportedModel, source: str, treatment: Treatment) -> str:
    return " ".join(item.meaning for item in deck.items if source in item.source and item.treatment is treatment)


def coefficients(platform: Platform, member: Member) -> dict[str, float]:
    return platform.coefficients[member.group].numbers()


def cut(members: list[Member]) -> dict[tuple[float, ...], tuple[Member, float]]:
    """Members with their sizes at the lower end, by both ends, cut at their stations."""
    sections = {}
    for member in members:
        low, high = (member.a, member.b) if member.a[2] <= member.b[2] else (member.b, member.a)
        reversed_ = member.a[2] > member.b[2]
        places = np.round(member.stations, 5)
        for i in range(len(places) - 1):
            if places[i + 1] == places[i]:
                continue
            at = (1 - places[[i + 1, i]]) if reversed_ else places[[i, i + 1]]
            ends = np.concatenate([low + fraction * (high - low) for fraction in at])
            sections[tuple(np.round(ends + KEY_OFFSET, 2) + 0.0)] = (
                member,
                float(member.sizes[i + 1 if reversed_ else i].sum()),
            )
    return sections


@pytest.mark.parametrize("name", BUILT_IN)
def test_mass_damping_mooring_and_water_come_back(trips: dict[str, RoundTrip], name: str) -> None:
    before, after = trips[name].before, trips[name].after
    for written, read in zip(before.rigid_body.combined(), after.rigid_body.combined(), strict=True):
        assert np.abs(np.asarray(read) - written).max() <= SAME * np.abs(written).max()
    assert after.linear_damping.matrix() == pytest.approx(before.linear_damping.matrix(), rel=SAME)
    assert after.water == before.water
    assert isinstance(before.mooring, StiffnessMatrix) and isinstance(after.mooring, StiffnessMatrix)
    assert after.mooring.matrix() == pytest.approx(before.mooring.matrix(), rel=SAME)
    assert after.mooring.preload == pytest.approx(before.mooring.preload, rel=SAME)


@pytest.mark.parametrize("name", BUILT_IN)
def test_members_and_coefficients_come_back(trips: dict[str, RoundTrip], name: str) -> None:
    before, after = trips[name].before, trips[name].after
    written, read = cut(members_of(before)), cut(members_of(after))
    assert written.keys() == read.keys() and len(written) > 0
    for ends, (member, size) in written.items():
        returned_member, its = read[ends]
        assert its == pytest.approx(size, rel=SAME) and returned_member.circular is member.circular
        own, returned = coefficients(before, member), coefficients(after, returned_member)
        tapers = bool(np.ptp(returned_member.sizes, axis=0).any())
        for key in ("Ca_t", "Cd_t") if member.column and not tapers else ("Ca_t", "Ca_z", "Cd_t", "Cd_z"):
            assert returned[key] == pytest.approx(own[key] * (name != "iti-barge" or key[:2] == "Cd"), rel=SAME), (ends, key)


@pytest.mark.parametrize("name", BUILT_IN)
def test_ends_have_the_same_added_mass_and_drag(trips: dict[str, RoundTrip], name: str) -> None:
    """Sum of Ca_z times volume, and sum of Cd_z times area, over all wet ends. Rings at steps are ends, too."""
    if name == "oc3-hywind":  # the taper itself is loaded in HydroDyn by AxCd and AxCa along it
        assert "AxCd = 2 Cd_z" in said(trips[name].deck, "Ca_z, Cd_z", Treatment.TAKEN)
        rows = (trips[name].folder / "hydrodyn.dat").read_text(encoding="utf-8").splitlines()
        taper = next(row.split() for row in rows if row.startswith("2 ") and len(row.split()) == 29)
        assert [float(taper[i]) for i in (13, 17, 21)] == [1.2, 0.65, 1.0]

    def sums(platform: Platform) -> np.ndarray:
        model = build(platform)
        ends = model.hull.ends
        inertia = next(load for load in model.loads if isinstance(load, EndInertia))
        count = len(ends.label) - len(ends.strip)
        mass = np.array([float(inertia.Ca.get((ends.labels[i], "z"), 0.0)) if ends.labels else 0.0 for i in ends.label])
        drag = np.array([float(model.values.get(f"{ends.labels[i]}.Cd_z", 0.0)) if ends.labels else 0.0 for i in ends.label])
        wet = np.asarray(ends.position)[2][:count] < 0.0
        first = (mass * np.asarray(ends.volume))[:count][wet].sum(), (drag * np.asarray(ends.facing))[:count][wet].sum()
        return np.array(first)

    before, after = sums(trips[name].before), sums(trips[name].after)
    if name == "oc4-deepcwind":  # its step at -14 m is a face of one member before, and the ring of two members after
        ring, volume = np.pi * (12.0**2 - 6.0**2), 2 / 3 * np.pi * (12.0**3 - 6.0**3)
        before = before + 3 * np.array([0.71 * volume, 2.74 * ring])
    assert after == pytest.approx(before, rel=1e-8)


def upright_buoyancy(model: Model) -> tuple[np.ndarray, np.ndarray]:
    """Buoyancy (N, N m) in the reference position, and its slope."""
    load = next(part for part in model.loads if isinstance(part, Buoyancy))
    weight = model.environment.density * model.environment.gravity

    def force(q: jax.Array) -> tuple[jax.Array, jax.Array]:
        force_at = load.force(q, rotation(q[3:]), weight)
        return force_at, force_at

    slope, force_at = one_program(jax.jacfwd(force, has_aux=True))(np.zeros(6))
    return np.asarray(force_at), np.asarray(slope)


def test_declared_hydrostatics_come_back(trips: dict[str, RoundTrip]) -> None:
    """Force and restoring at rest; what is read back is linear, and the members displace nothing."""
    trip = trips["volturnus-s"]
    written, read = (upright_buoyancy(build(p)) for p in (trip.before, trip.after))
    assert trip.after.hydrostatics.linear and not trip.before.hydrostatics.linear
    assert read[0][2] == pytest.approx(written[0][2], rel=SAME)
    assert np.diag(read[1])[2:5] == pytest.approx(np.diag(written[1])[2:5], rel=1e-6)
    assert "PtfmVol0" in said(trip.deck, "hydrostatics", Treatment.APPROXIMATED)
    assert not trips["oc3-hywind"].after.hydrostatics.file


def test_numbers_of_the_deck_in_the_definitions_of_hydrodyn(trips: dict[str, RoundTrip]) -> None:
    """By hand: AxCd = 2 Cd_z; CaA and CaB over ratios of 7 and 12.5 m, as in the deck that was made for OpenFAST by hand."""
    text = (trips["volturnus-s"].folder / "hydrodyn.dat").read_text(encoding="utf-8").splitlines()
    assert "1 4.46 0.12 1.0 0 0.0 1.0" in text
    box = next(row.split() for row in text if row.startswith("5 ") and len(row.split()) == 37)
    values = [float(box[i]) for i in (1, 5, 9, 13)]
    assert values == pytest.approx([4.96, 1.84, 1.87 * 4 * 7 / (np.pi * 12.5), 0.11 * 4 * 12.5 / (np.pi * 7)], rel=1e-9)


def test_what_hydrodyn_cannot_hold_is_named(trips: dict[str, RoundTrip]) -> None:
    assert "one diameter" in said(trips["volturnus-s"].deck, "diffraction", Treatment.LEFT_OUT)
    assert "MCFD = 12.5 m" in said(trips["volturnus-s"].deck, "diffraction", Treatment.APPROXIMATED)
    assert [m.maccamy_fuchs for m in trips["volturnus-s"].after.members] == [False, True, True, True, False, False, False]
    assert "above still water" in said(trips["iti-barge"].deck, "coefficients", Treatment.LEFT_OUT)
    assert said(trips["oc4-deepcwind"].deck, "centripetal", Treatment.LEFT_OUT)


def test_effects_and_laws_are_named_and_quadratic_damping_is_taken(tmp_path: Path) -> None:
    platform = load_platform("volturnus-s")
    laws = {"drag_t": {"law": "keulegan_carpenter", "exponent": 0.2, "reference": 5.0}}
    laws["drag_z"] = {"law": "high_pass", "cutoff": 0.05, "low_share": 0.4, "suction": 1.0}
    raw = platform.model_dump(exclude_unset=True)
    raw["coefficients"]["column"] |= laws
    raw["quadratic_damping"] = {"B44": 2.0e9}
    changed = Platform.model_validate(raw)
    model = build(changed)
    assert any(isinstance(load, QuadraticDamping) for load in model.loads)
    model = model.with_effect(StaticForce(force={"heave": 1000.0}))
    deck = export_deck(source_of(changed, model))
    assert "keulegan_carpenter" in said(deck, "drag_t", Treatment.LEFT_OUT)
    assert "= 1000 N" in said(deck, "static_offset", Treatment.LEFT_OUT)
    assert "1 4.46 0.12 1.0 1 0.05 0.4" in deck.texts["hydrodyn.dat"].splitlines()
    after = round_trip(changed, tmp_path / "deck").after
    assert after.quadratic_damping.matrix()[3, 3] == 2.0e9
    column = after.coefficients["column"]
    assert column.drag_z.model_dump(exclude_none=True) == laws["drag_z"]


def with_catenaries() -> Platform:
    """VolturnUS-S with lines of two segments, copied to headings, over a seabed of their own depth."""
    raw = load_platform("volturnus-s").model_dump(exclude_unset=True)
    chain = {"axial_stiffness": 3.27e9, "mass_per_length": 685.0, "diameter": 0.333}
    line = {"anchor": [837.6, 0.0, -180.0], "fairlead": [58.0, 0.0, -14.0], "heading": [60.0, 180.0, 300.0]}
    line["segments"] = [{"type": "chain", "length": 600.0}, {"type": "rope", "length": 240.0}]
    types = {"chain": chain, "rope": {"axial_stiffness": 1.0e9, "submerged_weight": 900.0}}
    raw["mooring"] = {"kind": "catenary", "line_types": types, "lines": [line], "seabed": {"depth": 180.0}}
    return Platform.model_validate(raw)


def test_catenaries_come_back(tmp_path: Path) -> None:
    """Lines of two segments, copied to headings, over a seabed of their own depth."""
    before = with_catenaries()
    trip = round_trip(before, tmp_path / "deck")
    written, read = before.mooring, trip.after.mooring
    assert isinstance(written, Catenary) and isinstance(read, Catenary)
    assert read.seabed.depth == 180.0
    water = before.water
    for name, kind in written.line_types.items():
        weight = kind.weight(water.density, water.gravity)
        assert read.line_types[name].weight(water.density, water.gravity) == pytest.approx(weight, rel=SAME)
        assert read.line_types[name].axial_stiffness == pytest.approx(kind.axial_stiffness, rel=SAME)
    ends = [np.concatenate(copy) for line in written.lines for copy in line.copies()]
    returned = [np.array([*line.anchor, *line.fairlead]) for line in read.lines]
    assert np.array(returned) == pytest.approx(np.array(ends), rel=SAME, abs=1e-8)
    assert all([s.length for s in line.segments] == [600.0, 240.0] for line in read.lines)
    assert "none is declared" in said(trip.deck, "line_types.rope", Treatment.APPROXIMATED)


def test_openfast_io_reads_the_deck(trips: dict[str, RoundTrip]) -> None:
    """NREL's own reader, which goes by line numbers: every line is where OpenFAST 5 has it."""
    folder = trips["volturnus-s"].folder
    reader = InputReader_OpenFAST()
    reader.FAST_InputFile, reader.FAST_directory = "main.fst", str(folder)
    reader.read_MainInput()
    reader.read_ElastoDyn(str(folder / "elastodyn.dat"))
    reader.read_ElastoDynTower(str(folder / "tower.dat"))
    reader.read_ElastoDynBlade(str(folder / "blade.dat"))
    reader.read_HydroDyn(str(folder / "hydrodyn.dat"))
    reader.read_SeaState(str(folder / "seastate.dat"))
    values = reader.fst_vt
    assert values["Fst"]["HydroFile"] == "hydrodyn.dat" and values["Fst"]["WtrDpth"] == 200.0
    assert values["ElastoDyn"]["PtfmMass"] == 20093000.0 and values["ElastoDyn"]["TwrNodes"] == 5
    assert values["HydroDyn"]["NMembers"] == 7 and values["HydroDyn"]["AddBLin"][3, 3] == 3.63e8
    assert values["HydroDyn"]["PropPot"] == [False] * 7
    assert values["SeaState"]["MCFD"] == 12.5 and values["SeaState"]["WaveMod"] == 1
