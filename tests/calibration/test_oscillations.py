"""Peaks of records."""

import numpy as np
import pytest
from scipy.signal import find_peaks

from calibration.campaign.oscillations import prominent_peaks


@pytest.mark.parametrize("kind", ["noise", "flat tops", "walk"])
def test_peaks_are_those_of_scipy(kind: str) -> None:
    random = np.random.default_rng(3)
    found = 0
    for size in range(60):
        x = random.normal(size=size)
        if kind == "flat tops":
            x = random.integers(0, 5, size).astype(float)
        elif kind == "walk":
            x = np.round(x.cumsum(), 1)
        for prominence in (0.0, 0.5, 1.0, 2.0):
            expected = find_peaks(x, prominence=prominence)[0]
            assert np.array_equal(prominent_peaks(x, prominence), expected)
            found += len(expected)
    assert found > 500
