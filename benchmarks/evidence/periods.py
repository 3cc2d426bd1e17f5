"""Section 2: the built-in volturnus-s against the published platform: natural periods, balance, volume."""

from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.evidence.common import ROOT, SHARED, Section, cached, fingerprint, say, table
from calibration.formatting import number

TITLE = "VolturnUS-S against its published data"
# (s) as worked out for this project: the report's inertia with the public WAMIT data; the report itself, rounded, in Hz
PERIODS = {"surge": 134.9, "heave": 20.42, "pitch": 27.64}
REPORT = {"surge": 0.007, "heave": 0.049, "pitch": 0.036}
TUNED = ("column.Ca_t", "pontoon.Ca_z", "column.Ca_z")
WAMIT = SHARED / "reference" / "iea15-umaine" / "HydroData" / "IEA-15-240-RWT-UMaineSemi.1"
WAMIT_PERIODS = {"surge": 134.87, "heave": 20.42, "pitch": 27.07}  # what `of_wamit` gives, for where the file is absent
# kg m2 about the reference point: the report's hull, tower (a uniform rod of 129.6 m), nacelle and rotor (a point)
PARTS = 1.251e10 + 17.839e6 * 14.94**2 + 1.263e6 * (56.5**2 + 129.6**2 / 12) + 0.991e6 * 149.9**2
ADDED = {"surge": 1.264e7, "heave": 2.693e7, "pitch": 1.247e10}  # kg, kg m2: WAMIT, at zero frequency
VOLUME = 20206.0  # m3, WAMIT
COLUMN, CENTRE, WIDTH, HEIGHT, RADIUS = 12.5, 10.0, 12.5, 7.0, 51.75  # m


def of_wamit() -> dict[str, float]:
    """Natural periods (s) of surge, heave and pitch together with WAMIT's added mass at each one's own frequency."""
    if not WAMIT.exists():
        return WAMIT_PERIODS
    table_of: dict[float, np.ndarray] = {}
    for period, i, j, added, *_ in (line.split() for line in WAMIT.read_text().splitlines()):
        table_of.setdefault(float(period), np.zeros((6, 6)))[int(i) - 1, int(j) - 1] = 1025.0 * float(added)
    # WAMIT writes -1 for zero frequency and 0 for infinite
    omega = {2 * np.pi / period if period > 0 else 0.0: a for period, a in table_of.items() if period != 0}
    grid = np.array(sorted(omega))
    stack, plane = np.array([omega[w] for w in grid]), [0, 2, 4]
    mass, height, gravity = 20.093e6, -2.32, 9.80665
    body = np.array([[mass, 0, mass * height], [0, mass, 0], [mass * height, 0, 4.24919e10 + mass * height**2]])
    pitch = 2.193e9 - mass * gravity * height + 2.586e8
    stiffness = np.array([[7.19e4, 0, 1.144e6], [0, 4.453e6 + 6.07e4, 0], [1.144e6, 0, pitch]])
    found = {}
    for mode, dof in enumerate(("surge", "pitch", "heave")):  # longest first
        period = PERIODS[dof]
        for _ in range(30):
            added = np.array([[np.interp(2 * np.pi / period, grid, stack[:, i, j]) for j in plane] for i in plane])
            square = np.linalg.eigvals(np.linalg.solve(body + added, stiffness))
            period = float(2 * np.pi / np.sqrt(np.sort(square.real)[mode]))
        found[dof] = period
    return found


def worked_out() -> dict[str, Any]:
    """Periods as shipped, with two and three coefficients tuned, and with the inertia instead of the third; balance; volume."""
    import equinox as eqx
    from scipy.optimize import least_squares

    from jaxhydro import equilibrium, load_model, natural_modes
    from jaxhydro.dynamics.statics import linearised
    from jaxhydro.loads.hydrostatics import buoyancy
    from jaxhydro.platform.build import members_of
    from jaxhydro.platform.schema import load_platform

    model = load_model("volturnus-s")

    def changed(x: np.ndarray) -> Any:
        other = model.with_values(dict(zip(TUNED, x)))
        return eqx.tree_at(lambda m: m.body.inertia, other, other.body.inertia.at[1, 1].multiply(x[3]))

    def periods(x: np.ndarray) -> np.ndarray:
        modes = natural_modes(changed(x))
        return np.array([modes.of(dof) for dof in PERIODS])

    def added(x: np.ndarray) -> list[float]:
        other = changed(x)
        mass = np.asarray(linearised(other, equilibrium(other))[0]) - np.asarray(other.body.mass_matrix())
        return [float(mass[i, i]) for i in (0, 2, 4)]

    shipped = np.array([*(float(model.values[label]) for label in TUNED), 1.0])
    goal = np.array(list(PERIODS.values()))
    end = shipped[2]  # column Ca_z

    def tuned(full: Any, start: np.ndarray, count: int) -> np.ndarray:
        return full(least_squares(lambda x: (periods(full(x)) / goal - 1)[:count], start, xtol=1e-12).x)

    two = tuned(lambda x: np.array([*x, end, 1.0]), shipped[:2], 2)
    three = tuned(lambda x: np.array([*x, 1.0]), two[:3], 3)
    inertia = tuned(lambda x: np.array([x[0], x[1], end, x[2]]), two[[0, 1, 3]], 3)
    cases = [shipped, two, three, inertia]
    weight = float(model.body.mass * model.environment.gravity)
    strips = buoyancy(members_of(load_platform("volturnus-s"))).upright(1.0)["displaced_volume"]
    return {
        "values": [x.tolist() for x in cases],
        "periods": [periods(x).tolist() for x in cases],
        "added": [added(x) for x in cases],
        "inertia": [float(changed(x).body.inertia_at_reference()[1, 1]) for x in cases],
        "imbalance": (np.asarray(model.force_at_rest(np.zeros(6))) / weight).tolist(),
        "strips": float(strips),
    }


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
    key = fingerprint(ROOT / "jaxhydro" / "platforms" / "volturnus-s.yaml", Path(__file__))
    found = cached("periods", key, "periods", worked_out)
    outer, hub = joints()
    counted = hub_by_counting()
    wamit = of_wamit()
    rows = [
        (
            dof,
            f"{REPORT[dof]:.3f}",
            f"{period:.2f}",
            f"{wamit[dof]:.2f}",
            *(f"{row[i]:.2f} ({100 * (row[i] / period - 1):+.2f} %)" for row in found["periods"]),
        )
        for i, (dof, period) in enumerate(PERIODS.items())
    ]
    masses = [
        (
            f"added mass in {dof}",
            f"{goal:.4g}",
            *(f"{row[i]:.4g} ({100 * (row[i] / goal - 1):+.1f} %)" for row in found["added"]),
        )
        for i, (dof, goal) in enumerate(ADDED.items())
    ]
    values = [(f"`{label}`", "–", *(number(row[i], 3) for row in found["values"])) for i, label in enumerate(TUNED)]
    values += [("pitch inertia about the reference point", "4.26e+10", *(f"{x:.4g}" for x in found["inertia"]))]
    strips, total = found["strips"], found["strips"] + 3 * outer + hub
    worst = max(abs(x) for x in found["imbalance"][:3])
    moment = max(abs(x) for x in found["imbalance"][3:])
    off, two, three, inertia = (max(abs(row[i] / p - 1) for i, p in enumerate(PERIODS.values())) for row in found["periods"])
    against = max(abs(found["periods"][1][i] / wamit[dof] - 1) for i, dof in enumerate(PERIODS))
    say(f"  as shipped {100 * off:.1f} % off, two tuned {100 * two:.2f} %, of WAMIT's {100 * against:.2f} %")
    head = ("As shipped", "Two tuned", "Three tuned", "Inertia too")
    text = (
        "The built-in `volturnus-s` has the report's mass and the public WAMIT data's inertia, hydrostatics and mooring "
        "stiffness. Its added mass comes from strips. Its natural periods (s, undamped, coupled) are compared with:\n\n"
        "- *Report*: the report's frequencies (NREL/TP-5000-76773, rounded to 0.001 Hz).\n"
        "- *Worked out*: the periods worked out for this project.\n"
        "- *WAMIT*: the periods of WAMIT's added mass, at each period's own frequency, with WAMIT's inertia.\n\n"
        + table(("Motion", "Report (Hz)", "Worked out", "WAMIT", *head), rows)
        + f"\n- *As shipped*, with Table 1's coefficients, the periods are up to {100 * off:.1f} % off. The "
        "coefficients were tuned to another model of this hull in a basin, with other mass and moorings.\n"
        "- *Two tuned*: column `Ca_t` is tuned to the surge period and pontoon `Ca_z` to the heave period, by least "
        f"squares. Nothing else is changed. Pitch is then a prediction, {100 * two:.2f} % off the 27.64 s worked out "
        f"(goal 2 %: {'met' if two < 0.02 else 'not met'}). All three periods are within {100 * against:.2f} % of WAMIT's.\n"
        "- *Three tuned*: column `Ca_z`, of the ends, is tuned too. All three periods are within "
        f"{100 * three:.3f} % (goal 2 %: {'met' if three < 0.02 else 'not met'}). The end coefficient then stands for an "
        "inertia.\n"
        f"- *Inertia too*: the pitch inertia is tuned in the place of column `Ca_z`. All three periods are within "
        f"{100 * inertia:.3f} %.\n\n"
        "The 27.64 s do not follow from WAMIT's data. They need a pitch inertia of "
        f"{found['inertia'][3]:.4g} kg m²; WAMIT's data have 4.26e+10. The report's parts give about the inertia needed: "
        f"{PARTS:.4g} with the tower as a uniform rod, nacelle and rotor as a point.\n\n"
        + table(("Quantity (-, kg, kg m²)", "WAMIT, zero frequency", *head), values + masses)
        + f"\n**Balance.** At its reference position the net force on the platform is {100 * worst:.2g} % of the weight "
        f"(goal 0.1 %: {'met' if worst < 1e-3 else 'not met'}). The net moment is {100 * moment:.2g} % of the weight times "
        "1 m.\n\n"
        f"**Volume.** The strips run from column face to column face and displace {strips:,.0f} m³; WAMIT's hull displaces "
        f"{VOLUME:,.0f} m³. The joints are the difference: the platform file declares the volume, by which the hull floats.\n\n"
        + table(
            ("Volume", "m³"),
            [
                ("strips", f"{strips:,.1f}"),
                (
                    "between the pontoons' flat ends and the round outer columns, 3 x 7 (12.5 x 6.25 - π 6.25² / 2)",
                    f"{3 * outer:,.1f}",
                ),
                (
                    "hub: three bands to the axis, less the centre column, less what the strips count "
                    f"(by counting cells: {counted:.1f})",
                    f"{hub:,.1f}",
                ),
                ("sum", f"{total:,.1f}"),
                ("WAMIT", f"{VOLUME:,.1f}"),
            ],
        )
        + f"\nThe sum is {total - VOLUME:+.1f} m³ ({100 * (total / VOLUME - 1):+.4f} %) off.\n"
    )
    short = [f"as shipped, with Table 1's coefficients, the built-in platform's periods are up to {100 * off:.1f} % off"]
    if two >= 0.02:
        short.append(
            f"with two coefficients tuned to surge and heave the pitch period is {100 * two:.2f} % off (three "
            f"meet the goal of 2 %). It is {100 * against:.2f} % off what its own mass data give with WAMIT"
        )
    return Section(TITLE, text, (), tuple(short))
