"""An OpenFAST 5 deck of a platform: ElastoDyn, HydroDyn, SeaState and MoorDyn.

The counterpart of `openfast_deck`, which reads it back.
"""

import math
from collections.abc import Iterator

import jax.numpy as jnp
import numpy as np

from jaxhydro.dynamics.statics import linearised
from jaxhydro.interop.conversion import ConvertedItem, Treatment
from jaxhydro.interop.export_effects import effects_left_out, plain_load
from jaxhydro.interop.export_source import ExportedModel, ExportSource
from jaxhydro.interop.openfast.export_elastodyn import elastodyn_files
from jaxhydro.interop.openfast.export_flow import exported_flow
from jaxhydro.interop.openfast.export_members import member_tables
from jaxhydro.interop.openfast.export_moordyn import IN_OPENFAST, moordyn_file
from jaxhydro.interop.openfast.export_terms import exported_terms
from jaxhydro.interop.openfast.export_text import digits, filled
from jaxhydro.loads import (
    AddedMass,
    Buoyancy,
    CatenaryLines,
    ComputedAddedMass,
    ComputedExcitation,
    ComputedRadiation,
    DriftTransfer,
    EndInertia,
    HydrostaticCoupling,
    LinearDamping,
    MooringLines,
    MorisonDrag,
    QuadraticDamping,
    Stiffness,
    StripInertia,
    TensionTableLines,
    Weight,
)

RIPPLE = 1e-6  # m, height of the waves of a deck with the keyword MCF: SeaState has none of it in still water
GRID_MARGIN = 50.0  # m, of SeaState's grid beyond the hull, and below it
GRID_SPACING = 5.0  # m along x: SeaState interpolates linearly, which takes 0.3 % off waves of 10 s
TIME_STEPS = (0.025, 0.02, 0.0125, 0.01, 0.005, 0.004, 0.0025, 0.002, 0.00125, 0.001, 0.0005, 0.0002, 0.0001)  # s
STEPS_PER_PERIOD = 24  # of the shortest natural period: OpenFAST diverges with 3, and is 9 % off with 15
WRITTEN = (
    *(AddedMass, Buoyancy, CatenaryLines, ComputedAddedMass, ComputedExcitation, ComputedRadiation, DriftTransfer, EndInertia),
    *(HydrostaticCoupling, LinearDamping, MooringLines, MorisonDrag, QuadraticDamping, Stiffness, StripInertia),
    *(TensionTableLines, Weight),
)


def export_deck(source: ExportSource) -> ExportedModel:
    """Files of an OpenFAST 5 deck, and what became of each item of a platform.

    Args:
        source: The platform.

    Returns:
        Texts of the files, in SI units, and files to copy.

    Raises:
        InputError: A table of potential flow cannot be read.
    """
    flow, terms = exported_flow(source), exported_terms(source)
    tables = member_tables(source, flow.buoyant, bool(flow.excitation))
    texts, items = elastodyn_files(source)
    model, water = source.model, source.model.environment
    displaced = int(model.conventions.waves_at == "displaced")
    stretched = int(model.conventions.wetting == "instantaneous")
    items = [_water(source), *items, *_members(source), *tables.notes.items("in the deck"), *flow.items, *terms.items]
    lines = [load for load in map(plain_load, model.loads) if isinstance(load, CatenaryLines)]
    for load in lines:
        texts[IN_OPENFAST], line_items = moordyn_file(source, load, IN_OPENFAST)
        items += line_items
    texts["hydrodyn.dat"] = filled(
        "hydrodyn.dat",
        name=source.name,
        flow=flow,
        terms=terms.rows(),
        displaced=displaced,
        stretched=stretched,
        **tables.rows,
    )
    places = np.array([end for member in source.members for end in (member.a, member.b)] or [np.zeros(3)])
    half_width = np.ceil(np.abs(places[:, :2]).max()) + GRID_MARGIN
    ripple = RIPPLE if tables.diameter else 0.0
    texts["seastate.dat"] = filled(
        "seastate.dat",
        name=source.name,
        half_width=digits(half_width),
        points=2 * math.ceil(half_width / GRID_SPACING) + 1,
        grid_depth=digits(min(float(water.depth), np.ceil(-places[:, 2].min()) + GRID_MARGIN)),
        ripple=ripple,
        stretched=stretched,
        cylinder=digits(tables.diameter),
    )
    values = {key: digits(getattr(water, key)) for key in ("density", "depth", "gravity")}
    texts["main.fst"] = filled("main.fst", name=source.name, lines=bool(lines), step=time_step(source), **values)
    items += [_sea(ripple), *_forms(source), *effects_left_out(source, WRITTEN)]
    return ExportedModel(texts | flow.texts, tuple(items), flow.files)


def time_step(source: ExportSource) -> float:
    """Time step (s) of OpenFAST, DT, that resolves the shortest natural period at the reference position.

    Args:
        source: The platform.
    """
    mass, stiffness = (np.asarray(matrix) for matrix in linearised(source.model, jnp.zeros(6)))
    fastest = math.sqrt(max(0.0, np.linalg.eigvals(np.linalg.solve(mass, stiffness)).real.max()))
    longest = 2 * math.pi / fastest / STEPS_PER_PERIOD if fastest else math.inf
    return next((step for step in TIME_STEPS if step <= longest), TIME_STEPS[-1])


def _water(source: ExportSource) -> ConvertedItem:
    water = source.model.environment
    told = f"{float(water.density):g} kg/m³, {float(water.depth):g} m, {float(water.gravity):g} m/s²"
    return ConvertedItem("water", Treatment.TAKEN, f"WtrDens, WtrDpth and Gravity: {told}. MSL2SWL is 0.")


def _members(source: ExportSource) -> Iterator[ConvertedItem]:
    if not source.members:
        return
    text = (
        f"{len(source.members)} members with their copies, cut at their stations, with coefficients by member (MCoefMod 3). "
        "AxCd is 2 Cd_z; CaA and CaB are Ca over a ratio of sides (conventions, OpenFAST)."
    )
    yield ConvertedItem("members, coefficients", Treatment.TAKEN, text)
    text = "HydroDyn's nodes are at most MDivSize apart; here strips are at Gauss points."
    yield ConvertedItem("members: elements, points", Treatment.APPROXIMATED, text)


def _sea(ripple: float) -> ConvertedItem:
    grid = "SeaState's grid is for waves along x: for other headings set NY as NX."
    if not ripple:
        return ConvertedItem("sea", Treatment.TAKEN, f"Still water (WaveMod 0). Set WaveMod in seastate.dat. {grid}")
    text = (
        f"A regular wave of {1e3 * ripple:g} mm stands for still water, as SeaState has no MacCamy-Fuchs diffraction with "
        f"WaveMod 0. Set WaveMod and WaveHs in seastate.dat. {grid}"
    )
    return ConvertedItem("sea", Treatment.APPROXIMATED, text)


def _forms(source: ExportSource) -> Iterator[ConvertedItem]:
    """Forms of the strip loads."""
    forms = source.model.conventions
    if forms.directions == "body":
        text = "HydroDyn loads strips along the axes of the upright platform; here they turn with it."
        yield ConvertedItem("directions", Treatment.APPROXIMATED, text)
    else:
        yield ConvertedItem("directions", Treatment.TAKEN, "Axes of the upright platform, as in HydroDyn.")
    if forms.wetting == "instantaneous":
        text = (
            "WaveStMod 1 and AMMod 1. Buoyancy is that up to still water (HstMod 0), as here. HydroDyn spreads the load of the "
            "piece at the surface over two nodes: mean and slow surge in waves differ a little."
        )
        yield ConvertedItem("wetting", Treatment.TAKEN, text)
    else:
        yield ConvertedItem("wetting", Treatment.TAKEN, "WaveStMod 0 and AMMod 0.")
    yield ConvertedItem("waves_at", Treatment.TAKEN, f"WaveDisp {int(forms.waves_at == 'displaced')}, ExctnDisp alike.")
    if forms.centripetal:
        text = "Strips here feel the centripetal part of their acceleration too."
        yield ConvertedItem("centripetal", Treatment.LEFT_OUT, text)
    if any(isinstance(load, MorisonDrag) and not load.coupled for load in map(plain_load, source.model.loads)):
        text = "HydroDyn's drag is by the vector of the flow (FDMod 0), not by each component."
        yield ConvertedItem("drag_speed", Treatment.LEFT_OUT, text)
