"""ElastoDyn's files: a rigid platform that carries the whole mass, and a tower and blades of no mass.

References:
    OpenFAST v5.0.0 (2895884), ElastoDyn_IO.f90: ValidatePrimaryData (PtfmCMzt below TowerBsHt, TowerHt above TipRad),
    ValidateTowerData and ValidateBladeData (a mass per length above 0).
"""

import numpy as np

from jaxhydro.interop.conversion import ConvertedItem, Treatment
from jaxhydro.interop.export_source import ExportSource
from jaxhydro.interop.openfast.export_text import digits, filled

LINE_MASS = 1e-6  # kg/m of tower and blades: ElastoDyn stops at 0
TOWER_LENGTH = 20.0  # m
CLEARANCE = 10.0  # m, of the tower's base above the centre of mass and still water


def elastodyn_files(source: ExportSource) -> tuple[dict[str, str], list[ConvertedItem]]:
    """Texts of ElastoDyn's files by name, and what became of the mass.

    Args:
        source: The platform.
    """
    body = source.model.body
    mass, centre, inertia = float(body.mass), np.asarray(body.centre, float), np.asarray(body.inertia, float)
    base = max(0.0, float(np.ceil(centre[2]))) + CLEARANCE
    entries = {"Ixx": (0, 0), "Iyy": (1, 1), "Izz": (2, 2), "Ixy": (0, 1), "Iyz": (1, 2), "Ixz": (0, 2)}
    values = {
        "name": source.name,
        "mass": digits(mass),
        "centre": [digits(value) for value in centre],
        "inertia": {key: digits(inertia[index]) for key, index in entries.items()},
        "tower_base": digits(base),
        "tower_top": digits(base + TOWER_LENGTH),
        "line_mass": digits(LINE_MASS),
    }
    text = (
        f"PtfmMass {mass:.6g} kg, its centre and its inertia about that: tower, nacelle and rotor are in the platform. "
        f"ElastoDyn wants a tower and blades: theirs are {LINE_MASS:g} kg/m. All degrees of freedom but the platform's are off."
    )
    files = {name: filled(name, **values) for name in ("elastodyn.dat", "tower.dat", "blade.dat")}
    return files, [ConvertedItem("rigid_body", Treatment.TAKEN, text)]
