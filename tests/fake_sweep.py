"""A small platform on three lines, and a small sweep of it: one compiled size for all tests."""

import json
from pathlib import Path
from typing import Any

PLATFORM = """
name: Buoy
water: {density: 1025.0, depth: 100.0}
rigid_body: {mass: 6.3e6, centre_of_mass: [0.0, 0.0, -12.0], inertia: {Ixx: 9.0e8, Iyy: 9.0e8, Izz: 2.0e8}}
members:
  - {name: column, group: column, shape: circ, d: 20.0, rA: [0, 0, -20], rB: [0, 0, 10]}
coefficients:
  column: {Ca_t: 1.0, Ca_z: 0.6, Cd_t: 1.0, Cd_z: 4.0}
linear_damping: {B11: 2.0e5, B33: 2.0e5, B55: 2.0e7}
sea_state_laws:
  reference: {significant_height: 2.0, peak_period: 8.0}
  exponents: {column.Cd_t: {significant_height: -0.5}, linear_damping.B11: {peak_period: 1.5}}
mooring:
  kind: linear_springs
  lines:
    - {anchor: [200.0, 0.0, -20.0], fairlead: [10.0, 0.0, -10.0], stiffness: 1.0e5, pretension: 1.0e6}
    - {anchor: [-100.0, 173.2, -20.0], fairlead: [-5.0, 8.66, -10.0], stiffness: 1.0e5, pretension: 1.0e6}
    - {anchor: [-100.0, -173.2, -20.0], fairlead: [-5.0, -8.66, -10.0], stiffness: 1.0e5, pretension: 1.0e6}
"""
BREAKING = {"hs": 20.0, "tp": 9.0, "probability": 5}
SWEEP: dict[str, Any] = {
    "platform": "buoy.yaml",
    "scatter": [{"hs": 1.5, "tp": 7.0, "probability": 60}, {"hs": 3.0, "tp": 9.0, "probability": 35}, BREAKING],
    "seeds": 8, "duration": 150.0, "order": 1, "cutoff": 0.15, "motions": ["surge", "heave", "pitch"], "time_series": True,
}  # fmt: skip


def written(folder: Path, **changes: Any) -> Path:
    """A sweep's files; a key that is None is left out. JSON is YAML."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "buoy.yaml").write_text(PLATFORM)
    (folder / "sweep.yaml").write_text(json.dumps({k: v for k, v in (SWEEP | changes).items() if v is not None}))
    return folder / "sweep.yaml"
