"""Makes tests/data/maccamy_fuchs_capytaine.csv: the surge force on a vertical cylinder in waves, from panels.

    python benchmarks/make_diffraction_table.py [--out FILE]

Capytaine, which is no dependency of the project, is needed: have it in an environment of its own (pip install capytaine).
The cylinder stands on the bed and pierces the surface; it has no bottom panels and no lid. The surge of its inside, open
to the bed, has its first irregular frequency where J1(ka) = 0, ka = 3.83, above all that is asked here.

Capytaine counts time by exp(-i omega t): the force, diffraction and Froude-Krylov, over rho pi a^2 times the depth integral
of the undisturbed acceleration on the axis, -i g tanh(kh) for a wave of unit amplitude, is the conjugate of the
coefficient in exp(+i omega t). Capytaine's direct method is used, second order in the size of the panels (the indirect one
is of first order, and 1 % off with 48 x 80 panels). Meshes are refined alike in both directions, and the last two
extrapolated to panels of no size; the difference between the last two extrapolations is printed.
About half a minute; runs differ by 1e-5.
"""

import argparse
import math
from pathlib import Path

import capytaine as cpt
import numpy as np
from capytaine.bem.airy_waves import froude_krylov_force

TABLE = Path(__file__).resolve().parents[1] / "tests" / "data" / "maccamy_fuchs_capytaine.csv"
RADIUS, DEPTH = 6.25, 30.0  # m
DENSITY, GRAVITY = 1025.0, 9.81  # kg/m3, m/s2
KA = (0.05, 0.1, 0.2, 0.3, 0.5, 0.75, 1.0, 1.25, 1.5, 2.0, 2.5)
MESHES = ((32, 48), (48, 72), (72, 108))  # panels around, panels down


def cylinder(around: int, down: int) -> cpt.FloatingBody:
    """The wall of the cylinder from the bed to the surface, free to surge."""
    mesh = cpt.mesh_vertical_cylinder(
        radius=RADIUS, length=DEPTH, center=(0, 0, -DEPTH / 2), resolution=(0, around, down), axial_symmetry=True
    )
    body = cpt.FloatingBody(mesh=mesh, name=f"{around} x {down}")
    body.dofs["Surge"] = np.tile([1.0, 0.0, 0.0], (mesh.nb_faces, 1))
    return body


def coefficient(body: cpt.FloatingBody, solver: cpt.BEMSolver, ka: float) -> complex:
    """The complex inertia coefficient, by exp(+i omega t)."""
    problem = cpt.DiffractionProblem(
        body=body, wavenumber=ka / RADIUS, wave_direction=0.0, water_depth=DEPTH, rho=DENSITY, g=GRAVITY
    )
    force = solver.solve(problem, keep_details=False).forces["Surge"] + froude_krylov_force(problem)["Surge"]
    acceleration = -1j * GRAVITY * math.tanh(ka / RADIUS * DEPTH)
    return complex(np.conj(force / (DENSITY * math.pi * RADIUS**2 * acceleration)))


def extrapolated(coarse: np.ndarray, fine: np.ndarray, ratio: float) -> np.ndarray:
    """Richardson's extrapolation, error of second order, panels smaller by `ratio`."""
    return fine + (fine - coarse) / (ratio**2 - 1)


def main() -> None:
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("--out", type=Path, default=TABLE)
    out = arguments.parse_args().out
    cpt.set_logging("ERROR")
    solver = cpt.BEMSolver(method="direct")
    by_mesh = []
    for around, down in MESHES:
        body = cylinder(around, down)
        by_mesh.append(np.array([coefficient(body, solver, ka) for ka in KA]))
        print(around, down, np.round(np.abs(by_mesh[-1]), 5), np.round(-np.degrees(np.angle(by_mesh[-1])), 4), sep="\n")
    first = extrapolated(by_mesh[0], by_mesh[1], MESHES[1][0] / MESHES[0][0])
    last = extrapolated(by_mesh[1], by_mesh[2], MESHES[2][0] / MESHES[1][0])
    print("between extrapolations", np.max(np.abs(last / first - 1)))
    print("from the last to the finest mesh", np.max(np.abs(by_mesh[2] / last - 1)))
    lines = [
        f"# made by `python benchmarks/make_diffraction_table.py` with Capytaine {cpt.__version__}; do not edit",
        f"# vertical cylinder from bed to surface, radius {RADIUS} m, depth {DEPTH} m; extrapolated from {MESHES[1:]} panels",
        "# inertia coefficient of the whole depth: amplitude, and lag of the force behind the axis' undisturbed acceleration",
        "ka,kh,inertia_coefficient,lag_deg",
    ]
    for ka, value in zip(KA, last):
        lines.append(f"{ka},{ka / RADIUS * DEPTH:.6g},{abs(value):.4f},{-math.degrees(np.angle(value)):.3f}")
    out.parent.mkdir(parents=True, exist_ok=True)
    out.write_text("\n".join(lines) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
