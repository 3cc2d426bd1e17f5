"""Records of a point that is not the reference point, moved to it when they are read."""

import json

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from numpy.testing import assert_allclose

from calibration.campaign.manifest import read_manifest
from calibration.campaign.records import load_records
from calibration.campaign.tracked_point import move_to_reference
from jaxhydro.environment import DOFS
from jaxhydro.errors import InputError
from jaxhydro.sensors import SensorReference

SCALE = 50.0
POINT = (0.04, 0.0, -0.3)  # m at the scale of the files


def motion(n: int = 200) -> tuple[np.ndarray, np.ndarray]:
    """Times and six motions (m, rad) at the scale of the files."""
    time = 0.02 * np.arange(n)
    sizes = np.array([0.05, 0.03, 0.02, 0.1, 0.2, 0.15])
    return time, sizes * np.sin(time[:, None] * np.array([2.0, 2.5, 3.0, 3.5, 4.0, 4.5]) + 0.3)


def seen(position: np.ndarray, point: tuple[float, float, float]) -> np.ndarray:
    """By the sensor effect that `diagnose` knows."""
    sensor = SensorReference(x=point[0], z=point[2])
    return np.asarray(jax.vmap(sensor.seen)(jnp.asarray(position)))


def campaign(folder, point=POINT, names=DOFS, change=lambda columns: columns) -> None:
    time, position = motion()
    columns = change(seen(position, point))[:, [DOFS.index(name) for name in names]]
    table = np.column_stack([time, columns])
    np.savetxt(folder / "a.csv", table, "%.9f", ",", header="t," + ",".join(names), comments="")
    channels = {name: {"column": name, "unit": "m" if DOFS.index(name) < 3 else "rad"} for name in names}
    test = {"id": "a", "kind": "decay", "degree_of_freedom": names[0], "file": "a.csv"}
    noise = {name: 1e-4 if name == "surge" else 2e-4 for name in names if name in ("surge", "pitch")}
    document = {
        "name": "point",
        "platform": "volturnus-s",
        "scale": SCALE,
        "tests": [test],
        "noise": noise,
        "channels": {"time": {"column": "t", "unit": "s"}, **channels},
        "tracked_point": POINT,
    }
    (folder / "campaign.yaml").write_text(json.dumps(document))


def test_motions_are_those_of_the_reference_point(tmp_path) -> None:
    """What the sensor effect makes of a motion comes back, at full scale; the noise has that of the angles in it."""
    campaign(tmp_path)
    (record,) = load_records(*read_manifest(tmp_path))
    _, position = motion()
    for i, name in enumerate(DOFS):
        assert_allclose(record.values[name], position[:, i] * (SCALE if i < 3 else 1.0), atol=1e-6)
    surge = SCALE * np.hypot(1e-4, POINT[2] * 2e-4)  # yaw's lever is y, which is 0
    assert record.noise["surge"] == pytest.approx(surge) and record.noise["pitch"] == 2e-4


def test_a_point_aside() -> None:
    """y too: against the rotation by hand, for a yaw of 90 degrees."""
    values = {"surge": np.array([-3.0]), "sway": np.array([-1.0]), "yaw": np.array([np.pi / 2])}
    moved = move_to_reference(values, (1.0, 2.0, 5.0))  # (1, 2) goes to (-2, 1)
    assert_allclose([moved["surge"], moved["sway"], moved["yaw"]], [[0.0], [0.0], [np.pi / 2]], atol=1e-12)


def test_an_angle_that_is_needed(tmp_path) -> None:
    campaign(tmp_path, names=("surge", "heave"))
    with pytest.raises(InputError) as error:
        read_manifest(tmp_path)
    message = str(error.value)
    assert "tests[0], tracked_point: expected a channel pitch, which moves the point in surge, since z is -0.3 m" in message
    assert "heave, since x is 0.04 m" in message and "yaw" not in message
