"""Natural periods, balance and volumes of the built-in volturnus-s, and periods by WAMIT's data."""

from typing import Any

import numpy as np

from benchmarks.evidence.common import SHARED

PERIODS = {"surge": 134.9, "heave": 20.42, "pitch": 27.64}  # s: worked out from the report's inertia and the public WAMIT data
TUNED = ("column.Ca_t", "pontoon.Ca_z", "column.Ca_z")
WAMIT = SHARED / "reference" / "iea15-umaine" / "HydroData" / "IEA-15-240-RWT-UMaineSemi.1"
WAMIT_PERIODS = {"surge": 134.87, "heave": 20.42, "pitch": 27.07}  # what `of_wamit` gives, for where the file is absent
COLUMN, CENTRE, WIDTH, HEIGHT, RADIUS = 12.5, 10.0, 12.5, 7.0, 51.75  # m


def of_wamit() -> dict[str, float]:
    """Natural periods (s) of surge, heave and pitch with WAMIT's added mass at each period's frequency."""
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
    periods = {}
    for mode, dof in enumerate(("surge", "pitch", "heave")):  # longest first
        period = PERIODS[dof]
        for _ in range(30):
            added = np.array([[np.interp(2 * np.pi / period, grid, stack[:, i, j]) for j in plane] for i in plane])
            square = np.linalg.eigvals(np.linalg.solve(body + added, stiffness))
            period = float(2 * np.pi / np.sqrt(np.sort(square.real)[mode]))
        periods[dof] = period
    return periods


def worked_out() -> dict[str, Any]:
    """Periods by what is tuned, balance and volume.

    Cases: as shipped, two coefficients tuned, three tuned, and the pitch inertia tuned in the place of the third.
    """
    import equinox as eqx
    from scipy.optimize import least_squares

    from jaxhydro import equilibrium, load_model, natural_modes
    from jaxhydro.dynamics.statics import linearised
    from jaxhydro.loads.hydrostatics import buoyancy
    from jaxhydro.platform.members_build import members_of
    from jaxhydro.platform.schema import load_platform

    model = load_model("volturnus-s")

    def changed(x: np.ndarray) -> Any:
        tuned_model = model.with_values(dict(zip(TUNED, x)))
        return eqx.tree_at(lambda m: m.body.inertia, tuned_model, tuned_model.body.inertia.at[1, 1].multiply(x[3]))

    def periods(x: np.ndarray) -> np.ndarray:
        modes = natural_modes(changed(x))
        return np.array([modes.of(dof) for dof in PERIODS])

    def added(x: np.ndarray) -> list[float]:
        tuned_model = changed(x)
        mass = np.asarray(linearised(tuned_model, equilibrium(tuned_model))[0]) - np.asarray(tuned_model.body.mass_matrix())
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


def joints() -> dict[str, float]:
    """Volumes (m3) that straight pontoons from column face to column face leave out.

    The hub is the union of three bands that run to the axis, less the centre column and less what the strips count. They count
    the bands from the column's face, their overlaps as often as they have them.

    Returns:
        `outer`, between a pontoon's flat end and the round outer column; `hub`; `hub counted`, the hub by counting cells.
    """
    r, w = COLUMN / 2, WIDTH / 2
    outer = HEIGHT * (WIDTH * r - np.pi * r**2 / 2)
    # within 60 deg of its own heading a band is a triangle up to w / tan 60 deg, and full beyond
    inner, end = CENTRE / 2, RADIUS - r
    corner = w / np.tan(np.pi / 3)
    union = 3 * (corner * w + (end - corner) * WIDTH)
    hub = HEIGHT * (union - np.pi * inner**2 - 3 * (end - inner) * WIDTH)
    return {"outer": float(outer), "hub": float(hub), "hub counted": float(hub_by_counting())}


def hub_by_counting(cell: float = 0.01) -> float:
    """Volume of the hub (m3) by counting cells of a plan, to check the analytic one."""
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
