"""Makes benchmarks/hulls/potential-flow.json: natural periods and motions in waves of the hulls there, from panels.

    python benchmarks/make_hull_coefficients.py [--out FILE]

Capytaine, which is no dependency of the project, is needed: have it in an environment of its own (pip install capytaine
ruamel.yaml). Masses, moorings and waves are those of the platform files and of evidence/hulls_cases.py; everything else is
worked out here. Hydrostatics are closed forms. OC4-DeepCwind is without its braces. The barge's moon pool is covered 1 cm
under still water, as in Jonkman's panels (NREL's forum, "ITI 5MW Barge"). About two minutes.
"""

import argparse
import itertools
import json
import math
from pathlib import Path

import capytaine as cpt
import numpy as np
from capytaine.bem.airy_waves import froude_krylov_force
from ruamel.yaml import YAML

HULLS = Path(__file__).with_name("hulls")
PLATFORMS = Path(__file__).resolve().parents[1] / "jaxhydro" / "platforms"
GRAVITY = 9.80665  # m/s2
LID = 0.01  # m, under still water
DOFS = ("Surge", "Sway", "Heave", "Roll", "Pitch", "Yaw")
WAVES = {"oc3-hywind": 20.0, "oc4-deepcwind": 14.0, "iti-barge": 20.0, "ship-section": 3.0}  # s
START = {"oc3-hywind": (31, 30), "oc4-deepcwind": (17.5, 26), "iti-barge": (8, 12), "ship-section": (1.3, 1.4)}  # s, about
HEADINGS = {"ship-section": 90.0}  # deg


def revolved(profile: list[tuple[float, float]], centre: tuple[float, float], size: float) -> list[np.ndarray]:
    """Panels (n, 4, 3) of a profile (radius, z) about a vertical axis, outward; `size` is that of a panel (m)."""
    panels = []
    for (r0, z0), (r1, z1) in itertools.pairwise(profile):
        around = max(32, math.ceil(2 * math.pi * max(r0, r1) / size))
        steps = max(1, math.ceil(math.hypot(r1 - r0, z1 - z0) / size))
        r, z = np.linspace(r0, r1, steps + 1), np.linspace(z0, z1, steps + 1)
        angle = np.linspace(0, 2 * math.pi, around + 1)
        at = np.stack(
            [
                centre[0] + r[:, None] * np.cos(angle),
                centre[1] + r[:, None] * np.sin(angle),
                np.repeat(z[:, None], around + 1, 1),
            ],
            axis=-1,
        )
        panels.append(np.stack([at[:-1, :-1], at[:-1, 1:], at[1:, 1:], at[1:, :-1]], axis=2).reshape(-1, 4, 3))
    return panels


def rectangle(corner: tuple, u: tuple, v: tuple, size: float) -> np.ndarray:
    """Panels (n, 4, 3) of corner, corner + u, corner + u + v, corner + v; their normal is u x v."""
    corner, u, v = (np.array(x, float) for x in (corner, u, v))
    n, m = (max(1, math.ceil(np.linalg.norm(x) / size)) for x in (u, v))
    at = corner + np.linspace(0, 1, n + 1)[:, None, None] * u + np.linspace(0, 1, m + 1)[:, None] * v
    return np.stack([at[:-1, :-1], at[1:, :-1], at[1:, 1:], at[:-1, 1:]], axis=2).reshape(-1, 4, 3)


def box(length: float, breadth: float, draught: float, size: float) -> list[np.ndarray]:
    """Panels of the sides of a box, without its bottom."""
    x, y, t = length / 2, breadth / 2, draught
    return [
        rectangle((x, -y, -t), (0, breadth, 0), (0, 0, t), size),
        rectangle((-x, y, -t), (0, -breadth, 0), (0, 0, t), size),
        rectangle((x, y, -t), (-length, 0, 0), (0, 0, t), size),
        rectangle((-x, -y, -t), (length, 0, 0), (0, 0, t), size),
    ]


def barge() -> list[np.ndarray]:
    """40 x 40 x 4 m with a moon pool of 10 x 10 m, covered 1 cm under still water."""
    size, top = 1.6, LID
    ring = [((-20, -20), (40, 15)), ((-20, 5), (40, 15)), ((-20, -5), (15, 10)), ((5, -5), (15, 10))]
    bottom = [rectangle((*a, -4), (0, b[1], 0), (b[0], 0, 0), size) for a, b in ring]
    walls = [panels[:, ::-1] - [0, 0, top] for panels in box(10, 10, 4 - top, size)]
    return [*box(40, 40, 4, size), *bottom, *walls, rectangle((-5, -5, -top), (0, 10, 0), (10, 0, 0), size)]


def panels_of(name: str) -> list[np.ndarray]:
    """Panels under still water of a hull."""
    if name == "oc3-hywind":
        return revolved([(1e-9, -120), (4.7, -120), (4.7, -12), (3.25, -4), (3.25, 0)], (0, 0), 1.5)
    if name == "oc4-deepcwind":
        base = [(1e-9, -20), (12, -20), (12, -14), (6, -14), (6, 0)]
        around = [(28.868 * math.cos(a), 28.868 * math.sin(a)) for a in np.radians([60, 180, 300])]
        parts = [revolved(base, centre, 2.0) for centre in around]
        return sum(parts, revolved([(1e-9, -20), (3.25, -20), (3.25, 0)], (0, 0), 1.5))
    if name == "iti-barge":
        return barge()
    return [*box(4.0, 0.4, 0.2, 0.06), rectangle((-2, -0.2, -0.2), (0, 0.4, 0), (4, 0, 0), 0.06)]


def body_of(name: str) -> cpt.FloatingBody:
    """The hull about its reference point."""
    panels = np.concatenate(panels_of(name))
    mesh = cpt.Mesh(panels.reshape(-1, 3), np.arange(4 * len(panels)).reshape(-1, 4), name=name)
    return cpt.FloatingBody(mesh=mesh, dofs=cpt.rigid_body_dofs(rotation_center=(0, 0, 0)), name=name)


def hydrostatics(body: cpt.FloatingBody, density: float) -> tuple[float, np.ndarray]:
    """Displaced volume (m3) and restoring by pressure alone (N/m, N m/rad): Newman 1977, sections 6.16 and 6.17.

    What is covered at `LID` has water above and is no part of the waterplane.
    """
    wet = body.mesh.faces_centers[:, 2] < -1.5 * LID
    x, y, z = body.mesh.faces_centers[wet].T
    down = -(body.mesh.faces_normals[:, 2] * body.mesh.faces_areas)[wet]  # of the waterplane, by the panels under it
    weight, arm = density * GRAVITY, float(-(0.5 * z**2 * down).sum())  # arm: integral of z over the volume
    areas = [0, 0, down.sum(), (y**2 * down).sum() + arm, (x**2 * down).sum() + arm, 0]
    return float(-(z * down).sum()), weight * np.diag(areas)


def rigid(platform: dict) -> tuple[np.ndarray, np.ndarray]:
    """Mass matrix about the reference point, and the restoring of the weight."""
    own = platform["rigid_body"]
    mass, weight = np.zeros((6, 6)), np.zeros((6, 6))
    for part in own.get("parts", [own]):
        m, (x, y, z) = part["mass"], part["centre_of_mass"]
        arm = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]], float)
        mass += np.block(
            [[m * np.eye(3), -m * arm], [m * arm, np.diag([part["inertia"][k] for k in ("Ixx", "Iyy", "Izz")]) - m * arm @ arm]]
        )
        weight[[3, 4], [3, 4]] -= m * GRAVITY * z
    return mass, weight


def moored(platform: dict) -> np.ndarray:
    """Stiffness of the mooring."""
    given, stiffness = platform["mooring"]["stiffness"], np.zeros((6, 6))
    for key, value in given.items():
        i, j = int(key[1]) - 1, int(key[2]) - 1
        stiffness[i, j] = value
        stiffness[j, i] = given.get(f"C{j + 1}{i + 1}", value)
    return stiffness


def solved(name: str) -> dict:
    """Natural periods (s), added mass there (kg, kg m2), and motion per metre of wave amplitude."""
    platform = YAML(typ="safe").load(PLATFORMS / f"{name}.yaml")
    density, depth = platform["water"]["density"], platform["water"]["depth"]
    body, solver = body_of(name), cpt.BEMSolver()
    volume, pressure = hydrostatics(body, density)
    mass, weight = rigid(platform)
    stiffness = pressure + weight + moored(platform)
    water = {"body": body, "water_depth": depth, "rho": density, "g": GRAVITY}

    across = name in HEADINGS
    names = ("sway", "heave", "roll") if across else ("surge", "heave", "pitch")
    modes = [1, 2, 3] if across else [0, 2, 4]
    part = np.ix_(modes, modes)
    mass, stiffness = mass[part], stiffness[part]

    def radiation(omega: float) -> tuple[np.ndarray, np.ndarray]:
        at = {**water, "water_depth": depth if omega > 0 else math.inf}  # Capytaine's tables end at kh = 0.1
        solutions = [
            solver.solve(cpt.RadiationProblem(radiating_dof=DOFS[j], omega=omega, **at), keep_details=False) for j in modes
        ]
        added, damping = (
            [[getattr(solution, what)[DOFS[i]] for solution in solutions] for i in modes]
            for what in ("added_masses", "radiation_dampings")
        )
        return np.array(added), np.array(damping)

    periods, masses = {}, {}
    for index, dof in enumerate(names):
        omega = 0.0 if index == 0 else 2 * math.pi / START[name][index - 1]  # in surge and sway nearly at zero frequency
        for _ in range(1 if index == 0 else 4):
            added = radiation(omega)[0]
            square, vectors = np.linalg.eig(np.linalg.solve(mass + added, stiffness))
            energy = np.abs(vectors * (stiffness @ vectors))  # of every motion, by mode
            omega = float(np.sqrt(square.real[np.argmax(energy[index] / energy.sum(axis=0))]))
        periods[dof], masses[dof] = 2 * math.pi / omega, np.diag(added).tolist()
    period, heading = WAVES[name], math.radians(HEADINGS.get(name, 0.0))
    omega = 2 * math.pi / period
    problem = cpt.DiffractionProblem(omega=omega, wave_direction=heading, **water)
    scattered, incident = solver.solve(problem, keep_details=False).forces, froude_krylov_force(problem)
    force = np.array([scattered[DOFS[i]] + incident[DOFS[i]] for i in modes])
    added, damping = radiation(omega)
    motion = np.linalg.solve(stiffness - omega**2 * (mass + added) - 1j * omega * damping, force)
    return {
        "panels": int(body.mesh.nb_faces),
        "volume": volume,
        "pressure": np.diag(pressure)[2:5].tolist(),
        "periods": periods,
        "added_mass": masses,
        "wave": {
            "period": period,
            "heading": math.degrees(heading),
            "added_mass": np.diag(added).tolist(),
            "motion": dict(zip(names, np.abs(motion).tolist())),
            "force": dict(zip(names, np.abs(force).tolist())),
        },
    }


def main() -> None:
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("--out", type=Path, default=HULLS / "potential-flow.json")
    arguments.add_argument("--only", nargs="+", default=list(WAVES))
    options = arguments.parse_args()
    cpt.set_logging("ERROR")
    results = json.loads(options.out.read_text("utf-8")) if options.out.exists() else {}
    results["made_by"] = f"python benchmarks/make_hull_coefficients.py, Capytaine {cpt.__version__}"
    for name in options.only:
        results[name] = solved(name)
        print(name, json.dumps(results[name]["periods"]), flush=True)
        options.out.write_text(json.dumps(results, indent=1, sort_keys=True) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
