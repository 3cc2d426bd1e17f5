"""P-Q analysis against the fit in the time domain, on synthetic decays of rising damping: the bias of each."""

import json
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

from benchmarks.evidence.common import Section, fingerprint, parallel, say, table

NAME = "classical_bias"
TITLE = "P-Q against the time domain"
FACTORS = (0.5, 1.0, 2.0, 3.0, 4.0, 5.5)  # of the pontoon's drag, below its bound of 30; of B33 their squares
RELEASED, DURATION, SAMPLING, NOISE = 3.5, 300.0, 0.2, 0.005  # m, s, s, m
LABELS = ("pontoon.Cd_z", "linear_damping.B33")
SEED = 5


def document(factor: float, start: float = 1.0) -> dict[str, Any]:
    """The demo's platform with its true coefficients, the two that damp heave multiplied, B33 by
    the square; `start`: off by that, to fit."""
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
    found: dict[str, Any] = {"p": p, "q": q_true}
    try:
        one = classical(time, measured, NOISE)
        found["half_cycles"] = len(one.half_cycles.first)
        found["first_ratio"] = float(one.half_cycles.damping_ratio[0])
        found["pq"] = [[b.value / t, b.lower / t, b.upper / t] for b, t in ((one.fit.linear, p), (one.fit.quadratic, q_true))]
    except ValueError as error:
        found["refused"] = str(error)
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
    found["fit"] = {
        label: [
            result.parameters[label].value / true_values[label],
            (result.parameters[label].standard_deviation or np.nan) / true_values[label],
        ]
        for label in LABELS
    }
    return found


def run(figures: Path, processes: int) -> Section:
    """All of them."""
    key = fingerprint(Path(__file__), Path(__file__).parents[1] / "reference_model.py")
    results: dict[str, dict[str, Any]] = {}
    names = tuple(f"{factor:g}" for factor in FACTORS)
    for name, found in parallel(NAME, key, names, of_factor, processes):
        say(f"  damping times {name}")
        results[name] = found
    return words([results[name] for name in names], figures)


def words(results: list[dict[str, Any]], figures: Path) -> Section:
    """The table and the figure."""

    def interval(triple: list[float]) -> str:
        return f"{triple[0]:.2f} [{triple[1]:.2f}, {triple[2]:.2f}]"

    rows = []
    for factor, found in zip(FACTORS, results, strict=True):
        fit = [f"{value:.3f} ± {deviation:.3f}" for value, deviation in (found["fit"][label] for label in reversed(LABELS))]
        if "pq" in found:
            pq = [f"{100 * found['first_ratio']:.0f} %", str(found["half_cycles"]), *map(interval, found["pq"])]
        else:
            pq = ["–", "–", "refused", "refused"]
        rows.append([f"{factor:g}", *pq, *fit])
    heads = (
        "Factor",
        "First half cycle's ratio",
        "Half cycles",
        "p / true [95 %]",
        "q / true [95 %]",
        "B33 / true ± sd",
        "`pontoon.Cd_z` / true ± sd",
    )
    text = f"""
A heave decay of the NumPy model starts from {RELEASED:g} m and lasts {DURATION:g} s, with noise of {1000 * NOISE:g} mm. The
pontoon's drag is multiplied by a factor and B33 by its square. The P-Q analysis (`classical`) gives p and q. They should be
B_lin/M and B_quad/M of the model (`model_damping`). The fit in the time domain frees the two coefficients, begun 1.6 times too
small. Everything else stays as it is.

{table(heads, rows)}
P-Q assumes that an extreme is a turning point of an undamped oscillation, and that a half cycle's amplitude is constant. The
fit has no such assumption. {held(results)}
"""
    worst = max(abs(found["fit"][label][0] - 1) / max(found["fit"][label][1], 1e-9) for found in results for label in LABELS)
    short = (f"a coefficient of the time-domain fit is {worst:.1f} of its deviations off",) if worst > 3.5 else ()
    return Section(TITLE, text, (draw(results, figures / "classical-bias.png"),), short)


def held(results: list[dict[str, Any]]) -> str:
    """How far P-Q is off, and how often its intervals hold the truth."""
    seen = [one["pq"] for one in results if "pq" in one]
    inside = sum(low <= 1 <= high for pair in seen for _, low, high in pair)
    off = [max((pair[i][0] - 1 for pair in seen), key=abs) for i in (0, 1)]
    wide = [np.ptp(seen[-1][i][1:]) / 2 for i in (0, 1)]
    linear, quadratic = (100 * results[-1]["fit"][label][1] for label in reversed(LABELS))
    return f"""At most p is {100 * off[0]:+.0f} % and q {100 * off[1]:+.0f} % off; {inside} of {2 * len(seen)} intervals
hold the truth. For the strongest damping they reach {100 * wide[0]:.0f} and {100 * wide[1]:.0f} % either way, from
{results[-1].get("half_cycles")} half cycles. The fit's deviations are {linear:.1f} and {quadratic:.1f} % there."""


def draw(results: list[dict[str, Any]], path: Path) -> Path:
    """Ratios to the truth against damping."""
    from jaxhydro.plots.style import MEASURED, SIMULATED, header, save, stack, style

    with style():
        figure, axes = stack([1.2, 1.2])
        artists = {}
        for ax, i, label, name in zip(axes, (0, 1), reversed(LABELS), ("linear", "quadratic")):
            ax.axhline(1.0, color="0.6", lw=0.7)
            seen = [(f, r["pq"][i]) for f, r in zip(FACTORS, results) if "pq" in r]
            x, triples = [f for f, _ in seen], np.array([t for _, t in seen])
            bars = np.abs(triples[:, 1:].T - triples[:, 0])
            artists["P-Q, 95 %"] = ax.errorbar(x, triples[:, 0], bars, fmt="o", color=MEASURED, ms=3, lw=0.8, capsize=2)[0]
            fit = np.array([r["fit"][label] for r in results])
            beside, wide = 0.1 + np.array(FACTORS), 2 * np.nan_to_num(fit[:, 1])
            artists["time domain, 2 sd"] = ax.errorbar(
                beside, fit[:, 0], wide, fmt="s", color=SIMULATED, ms=3, lw=0.8, capsize=2
            )[0]
            ax.set_xlim(0, 6)
            ax.set_ylim(0, 2)
            ax.set_ylabel(f"{name.capitalize()}\nover truth")
        axes[-1].set_xlabel("Factor of drag (of B33: its square)")
        header(figure, "Heave decays of rising damping", artists, 2)
        save(figure, path)
    return path
