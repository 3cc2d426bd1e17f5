"""Section 2: the built-in volturnus-s against the published platform: natural periods, balance, volume."""

from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.evidence.common import ROOT, Section, begin, cached, fingerprint, say, table
from calibration.formatting import number

TITLE = "VolturnUS-S against its published data"
# (s) the report's mass and inertia with the public WAMIT data's A(0) and stiffness; the report itself gives, rounded, in Hz
PERIODS = {"surge": 134.9, "heave": 20.42, "pitch": 27.64}
REPORT = {"surge": 0.007, "heave": 0.049, "pitch": 0.036}
TUNINGS = ("Two tuned (s)", "Three tuned (s)")
TUNED = ("column.Ca_t", "pontoon.Ca_z", "column.Ca_z")
ADDED = {"surge": 1.264e7, "heave": 2.693e7, "pitch": 1.247e10}  # kg, kg m2: WAMIT, at zero frequency
DISC = 0.64  # Ca_z of one side of a flat disc: (4/3) r^3 over the reference (2/3) pi r^3
VOLUME = 20206.0  # m3, WAMIT
COLUMN, CENTRE, WIDTH, HEIGHT, RADIUS = 12.5, 10.0, 12.5, 7.0, 51.75  # m


def worked_out() -> dict[str, Any]:
    """Periods as shipped, with two and with three coefficients tuned; imbalance at rest; volume of the strips."""
    from scipy.optimize import least_squares

    from jaxhydro import equilibrium, load_model, natural_modes
    from jaxhydro.loads.hydrostatics import buoyancy
    from jaxhydro.platform import members_of
    from jaxhydro.platform_schema import load_platform
    from jaxhydro.statics import linearised

    model = load_model("volturnus-s")

    def periods(values: dict[str, float]) -> np.ndarray:
        modes = natural_modes(model.with_values(values))
        return np.array([modes.of(dof) for dof in PERIODS])

    def tune(labels: tuple[str, ...], dofs: tuple[str, ...]) -> dict[str, float]:
        rows = [list(PERIODS).index(dof) for dof in dofs]
        goal = np.array([PERIODS[dof] for dof in dofs])
        start = [float(model.values[label]) for label in labels]

        def off(x: np.ndarray) -> np.ndarray:
            return periods(dict(zip(labels, x)))[rows] / goal - 1

        return dict(zip(labels, least_squares(off, start, bounds=(0, 10), xtol=1e-12, ftol=1e-12).x.tolist()))

    two = tune(TUNED[:2], ("surge", "heave"))
    three = tune(TUNED, ("surge", "heave", "pitch"))
    def added(values: dict[str, float]) -> list[float]:
        other = model.with_values(values)
        mass = np.asarray(linearised(other, equilibrium(other))[0]) - np.asarray(model.body.mass_matrix())
        return [float(mass[i, i]) for i in (0, 2, 4)]

    weight = float(model.body.mass * model.environment.gravity)
    imbalance = np.asarray(model.force_at_rest(np.zeros(6))) / weight
    strips = buoyancy(members_of(load_platform("volturnus-s"))).upright(1.0)["displaced_volume"]
    return {
        "shipped": {label: float(model.values[label]) for label in (*TUNED, "pontoon.Ca_t")},
        "as_shipped": periods({}).tolist(), "two": two, "with_two": periods(two).tolist(),
        "three": three, "with_three": periods(three).tolist(),
        "added": [added(values) for values in ({}, two, three)],
        "imbalance": imbalance.tolist(), "strips": float(strips),
    }  # fmt: skip


def joints() -> tuple[float, float]:
    """Volumes (m3) that straight pontoons from column face to column face leave out: at an outer column, at the hub.

    Outer: between the pontoon's flat end and the round column. Hub: the union of three bands that run to the axis, less the
    centre column and less what the strips count: the bands from the column's face, their overlaps as often as they have them.
    """
    r, w = COLUMN / 2, WIDTH / 2
    outer = HEIGHT * (WIDTH * r - np.pi * r**2 / 2)
    # within 60 deg of its own heading a band is a triangle up to w / tan 60 deg, and full beyond
    inner, end = CENTRE / 2, RADIUS - r
    corner = w / np.tan(np.pi / 3)
    union = 3 * (corner * w + (end - corner) * WIDTH)
    return outer, HEIGHT * (union - np.pi * inner**2 - 3 * (end - inner) * WIDTH)


def hub_by_counting(cell: float = 0.01) -> float:
    """The hub's volume again (m3), by counting cells of a plan: what the analytic one is checked against."""
    reach = 12.0  # m, beyond which the bands are apart
    x, y = np.meshgrid(*[np.arange(-reach, reach, cell) + cell / 2] * 2)
    union, counted = np.zeros(x.shape, dtype=bool), 0
    for heading in np.radians([60, 180, 300]):
        along, across = x * np.cos(heading) + y * np.sin(heading), y * np.cos(heading) - x * np.sin(heading)
        band = (along > 0) & (np.abs(across) < WIDTH / 2) & (np.hypot(x, y) < reach)
        union |= band
        counted += int((band & (along > CENTRE / 2)).sum())
    union &= np.hypot(x, y) > CENTRE / 2
    return HEIGHT * cell**2 * (int(union.sum()) - counted)


def run(figures: Path) -> Section:
    """Periods, balance and volume."""
    begin()
    key = fingerprint(ROOT / "jaxhydro" / "platforms" / "volturnus-s.yaml", Path(__file__))
    found = cached("periods", key, "periods", worked_out)
    outer, hub = joints()
    counted = hub_by_counting()
    rows = []
    for i, (dof, period) in enumerate(PERIODS.items()):
        cells = [f"{found[k][i]:.2f} ({100 * (found[k][i] / period - 1):+.2f} %)" for k in
                 ("as_shipped", "with_two", "with_three")]
        rows.append((dof, f"{REPORT[dof]:.3f}", f"{period:.2f}", *cells))
    masses = [
        (dof, f"{wamit:.4g}", *(f"{row[i]:.4g} ({100 * (row[i] / wamit - 1):+.1f} %)" for row in found["added"]))
        for i, (dof, wamit) in enumerate(ADDED.items())
    ]
    values = [(f"`{k}`", number(found["shipped"][k], 3), number(found["two"].get(k, found["shipped"][k]), 3),
               number(found["three"][k], 3)) for k in TUNED]
    strips, total = found["strips"], found["strips"] + 3 * outer + hub
    worst = max(abs(x) for x in found["imbalance"][:3])
    moment = max(abs(x) for x in found["imbalance"][3:])
    two = max(abs(found["with_two"][i] / p - 1) for i, p in enumerate(PERIODS.values()))
    three = max(abs(found["with_three"][i] / p - 1) for i, p in enumerate(PERIODS.values()))
    off = max(abs(found["as_shipped"][i] / p - 1) for i, p in enumerate(PERIODS.values()))
    say(f"  as shipped {100 * off:.1f} % off, two tuned {100 * two:.2f} %, three tuned {100 * three:.3f} %")
    text = (
        "The built-in `volturnus-s` has the report's mass and the public WAMIT data's inertia, hydrostatics and mooring "
        "stiffness; its added mass comes from strips. The published periods (NREL/TP-5000-76773) are rounded to 0.001 Hz; "
        "those in seconds are worked out from the same data with WAMIT's added mass at zero frequency.\n\n"
        + table(("Motion", "Report (Hz)", "Worked out (s)", "Table 1, as shipped (s)", *TUNINGS), rows)
        + f"\nAs shipped the periods are up to {100 * off:.1f} % off: Table 1's coefficients were tuned to another model of "
        "this hull in a basin, with other mass and moorings. Two tuned: column `Ca_t` to the surge period and pontoon `Ca_z` "
        "to the heave period, by least squares, nothing else touched; the pitch period is then a prediction. All three are "
        "within "
        f"{100 * two:.2f} % (goal 2 %: {'met' if two < 0.02 else 'not met'}). Three tuned: column `Ca_z` as well, to all three "
        f"periods; within {100 * three:.3f} %.\n\n"
        + table(("Coefficient", "Table 1", "Two tuned", "Three tuned"), values)
        + "\nAdded mass about the reference point (kg, kg m²), and how far it is from WAMIT's at zero frequency:\n\n"
        + table(("Motion", "WAMIT", "Table 1", "Two tuned", "Three tuned"), masses)
        + f"\nThe third coefficient is a number, not physics: one side of a flat disc has a `Ca_z` of {DISC}, and column "
        f"`Ca_z` comes out at {found['three']['column.Ca_z']:.2f}, because it alone moves vertical added mass outwards.\n"
        + f"\n**Balance.** Net force on the platform at its reference position: {100 * worst:.2g} % of the weight; net moment "
        f"{100 * moment:.2g} % of the weight times 1 m (goal 0.1 %: {'met' if worst < 1e-3 else 'not met'}).\n\n"
        f"**Volume.** The strips run from column face to column face and displace {strips:,.0f} m³; WAMIT's hull displaces "
        f"{VOLUME:,.0f} m³. The joints are the difference: the platform file declares the volume, by which the hull floats.\n\n"
        + table(("Volume", "m³"), [
            ("strips", f"{strips:,.1f}"),
            ("between the pontoons' flat ends and the round outer columns, 3 x 7 (12.5 x 6.25 - π 6.25² / 2)",
             f"{3 * outer:,.1f}"),
            ("hub: three bands to the axis, less the centre column, less what the strips count "
             f"(by counting cells: {counted:.1f})", f"{hub:,.1f}"),
            ("sum", f"{total:,.1f}"),
            ("WAMIT", f"{VOLUME:,.1f}"),
        ])
        + f"\nThe sum is {total - VOLUME:+.1f} m³ ({100 * (total / VOLUME - 1):+.4f} %) off.\n"
    )  # fmt: skip
    short = [f"as shipped, with Table 1's coefficients, the built-in platform's periods are up to {100 * off:.1f} % off"]
    if two >= 0.02:
        short.append(f"with two coefficients tuned to surge and heave the pitch period is {100 * two:.2f} % off; goal 2 %")
    if found["three"]["column.Ca_z"] > DISC:
        short.append("tuning pitch too needs a column Ca_z that no column end has: the strips' added mass is too far inwards")
    return Section(TITLE, text, (), tuple(short))
