"""The bench runs and says everything it should; how fast is not tested."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
KEYS = (
    "Decay against NumPy, RK4, 0.5 s",
    "Decay by Tsit5, 1 s",
    "diffrax over this package's loop, Tsit5, 1 s",
    "Error of Tsit5, 1 s",
    "Jacobian of 11 parameters in a decay",
    "Reverse gradient of a decay",
    "First result from the cache, import apart",
    "Compilation: tsit5",
    "Sea of order 2, simulated time over CPU time",
    "Sea of order 1 against NumPy, same scheme",
    "Of a step: the waves at strips and ends",
    "Of a step: the scheme, and keeping the path",
    "A step over that floor",
    "Sea with three catenaries over springs",
    "2 seas at once, float64, simulated time over CPU time",
    "2 seas at once, float32, simulated time over CPU time",
    "Calibration by least squares",
    "DE over least squares, simulations",
    "DE over least squares, CPU",
    "GA over least squares, simulations",
    "GA over least squares, CPU",
)


@pytest.mark.slow
def test_quick_bench(tmp_path, tmp_path_factory):
    command = [sys.executable, "-m", "benchmarks.bench", "--quick", "--out", str(tmp_path / "results.md")]
    # the processes it starts share what they compile
    cache = {"JAX_COMPILATION_CACHE_DIR": str(tmp_path_factory.mktemp("cache"))}
    shipped = ROOT / "benchmarks" / "results.md"
    before = shipped.read_bytes() if shipped.exists() else None
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False, env=cache | os.environ)
    assert done.returncode == 0, done.stderr
    lines = (tmp_path / "results.md").read_text(encoding="utf-8").splitlines()
    rows = [[cell.strip() for cell in line.strip("|").split("|")] for line in lines if line.startswith("| ")]
    assert rows[0] == ["what", "result", "goal", "prototype"]
    table = {what: result for what, result, *_ in rows[2:]}
    assert len(table) == len(rows) - 2 and set(KEYS) <= set(table)
    assert all(table.values())
    assert table["Decay against NumPy, RK4, 0.5 s"].endswith("times")
    # the same motion, whatever it took
    errors = [float(value) for value in table["Difference from NumPy with its own strips"].split("/")]
    assert errors == pytest.approx([0.0] * 3, abs=5e-3)
    kinematics = [table[f"Error of velocity / acceleration at 15 m, 5 deg, order {order}"].split(" / ") for order in (1, 2)]
    assert max(float(value) for pair in kinematics for value in pair) < 2e-5
    off = table["Largest error of float32 over the motion's deviation"].replace(",", "").split()[1::2]
    assert len(off) == 3 and 0 < max(float(value) for value in off) < 1e-3
    assert any("pymoo" in line and "jax" in line for line in lines)
    assert {path.name for path in tmp_path.iterdir()} == {"results.md"}
    assert (shipped.read_bytes() if shipped.exists() else None) == before
