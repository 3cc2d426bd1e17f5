"""Synthetic heave decays of rising damping, by P-Q analysis and by a fit in the time domain."""

import json
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

FACTORS = (0.5, 1.0, 2.0, 3.0, 4.0, 5.5)  # of the pontoon's drag, below its bound of 30; of B33 their squares
RELEASED, DURATION, SAMPLING, NOISE = 3.5, 300.0, 0.2, 0.005  # m, s, s, m
LABELS = ("pontoon.Cd_z", "linear_damping.B33")
SEED = 5


def document(factor: float, start: float = 1.0) -> dict[str, Any]:
    """Platform of the demo campaign with its true coefficients, those that damp heave multiplied.

    Args:
        factor: Factor of the pontoon's drag; B33 has its square.
        start: Further factor of both, for a fit to begin from.
    """
    from ruamel.yaml import YAML

    from benchmarks.make_demo_campaign import PLATFORM, TRUE_COEFFICIENTS, TRUE_DAMPING

    data = YAML(typ="safe").load(PLATFORM)
    data["coefficients"] = {group: dict(row) for group, row in TRUE_COEFFICIENTS.items()}
    data["coefficients"]["pontoon"]["Cd_z"] *= factor * start
    data["linear_damping"] = TRUE_DAMPING | {"B33": TRUE_DAMPING["B33"] * factor**2 * start}
    return data


def of_factor(name: str) -> dict[str, Any]:
    """One decay: made by the NumPy model, analysed, fitted."""
    import jaxhydro as jh
    from benchmarks.reference_model import ReferenceModel
    from calibration import calibrate, load_campaign, model_damping
    from calibration.decay_analysis.linear_quadratic import classical

    factor = float(name)
    maker = ReferenceModel(document(factor))
    time, q = maker.decay(np.eye(6)[2] * RELEASED, np.zeros(6), DURATION, SAMPLING, tolerance=1e-8)
    clean = (q - maker.equilibrium())[:, 2]
    measured = clean + np.random.default_rng(SEED).normal(0, NOISE, len(clean))
    model = jh.build(jh.Platform.model_validate(document(factor)))
    true = model_damping(model, "heave")
    p, q_true = true.rates
    results: dict[str, Any] = {"p": p, "q": q_true}
    try:
        analysis = classical(time, measured, NOISE)
        results["half_cycles"] = len(analysis.half_cycles.first)
        results["first_ratio"] = float(analysis.half_cycles.damping_ratio[0])
        pairs = ((analysis.fit.linear, p), (analysis.fit.quadratic, q_true))
        results["pq"] = [[b.value / t, b.lower / t, b.upper / t] for b, t in pairs]
    except ValueError as error:
        results["refused"] = str(error)
    with TemporaryDirectory() as folder:
        path = Path(folder)
        (path / "platform.yaml").write_text(json.dumps(document(factor, 1 / 1.6)))  # JSON is YAML
        np.savetxt(path / "heave.csv", np.column_stack([time, measured]), delimiter=",", header="t,z", comments="", fmt="%.6f")
        manifest = {
            "name": "heave",
            "platform": "platform.yaml",
            "noise": {"heave": NOISE},
            "zero": None,
            "channels": {"time": {"column": "t", "unit": "s"}, "heave": {"column": "z", "unit": "m"}},
            "tests": [{"id": "heave", "kind": "decay", "degree_of_freedom": "heave", "file": "heave.csv"}],
        }
        (path / "campaign.yaml").write_text(json.dumps({k: v for k, v in manifest.items() if v is not None}))
        result = calibrate(load_campaign(path), free=LABELS)
    true_values = {label: float(model.values[label]) for label in LABELS}
    results["fit"] = {
        label: [
            result.parameters[label].value / true_values[label],
            (result.parameters[label].standard_deviation or np.nan) / true_values[label],
        ]
        for label in LABELS
    }
    return results
