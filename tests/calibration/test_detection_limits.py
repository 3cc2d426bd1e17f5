"""Detection limits: what is left of an effect, against least squares, and the sizes that are named."""

import numpy as np
import pytest
from test_discovery import campaign_of, found_in
from test_linear_model import linear_model, selection

from calibration.discovery.diagnosis import DetectionLimit, Diagnosis
from calibration.discovery.selection.detection_limits import remainders
from calibration.report.diagnosis_words import describe_limit
from calibration.results import diagnosis_file as file


def test_the_remainder_is_what_least_squares_leaves() -> None:
    model = linear_model(5, {0: 0.8}, noise=3.0, own=2)
    model.slopes[:, 3] += 2.0 * model.slopes[:, 0]
    subset = selection(model).subset(())
    left = remainders(model, subset)
    weight = np.sqrt((model.freedom / np.maximum(subset.fit.levels, 1.0))[model.pool] * model.share)
    decay, rows = model.own[0], model.own[0].rows
    own = np.zeros((len(model.residual), 2))
    own[rows] = decay.slopes
    follow = np.column_stack([model.slopes[:, :2], own])
    prior = np.diag(1 / np.concatenate([model.width[:2], decay.width]))
    for column in (3, 4):
        rows_and_prior = np.vstack([weight[:, None] * follow, prior])
        target = np.append(weight * model.slopes[:, column], np.zeros(4))
        steps = np.linalg.lstsq(rows_and_prior, target, rcond=None)[0]
        rest = model.slopes[:, column] - follow @ steps
        assert left.rows(column) == pytest.approx(rest, abs=1e-9)
        information = ((target - rows_and_prior @ steps) ** 2).sum()
        assert left.information[column, column] == pytest.approx(information, rel=1e-9)
        assert left.total[column] == pytest.approx((target**2).sum(), rel=1e-9)


def test_an_effect_that_the_coefficients_can_follow_has_no_remainder() -> None:
    model = linear_model(4, {0: 0.8})
    model.slopes[:, 3] = model.slopes[:, 0] - 2.0 * model.slopes[:, 1]
    left = remainders(model, selection(model).subset(()))
    assert left.information[3, 3] < 1e-3 * left.total[3]  # but for the priors, which hold the coefficients
    assert left.information[2, 2] > 0.9 * left.total[2]


def friction_limit(diagnosis: Diagnosis) -> DetectionLimit:
    [friction] = [rejected for rejected in diagnosis.rejected if rejected.effect == "coulomb_friction"]
    [limit] = friction.limits
    return limit


@pytest.mark.slow
def test_what_is_above_its_detection_limit_is_named_and_what_is_below_is_not(tmp_path) -> None:
    """A body in which nothing is missing says how large friction would have to be; with half and twice of it, it is so."""
    for name in ("none", "half", "twice"):
        (tmp_path / name).mkdir()
    limit = friction_limit(found_in(campaign_of(tmp_path / "none", lambda x, v: 0.0)))
    assert 0 < limit.smallest < limit.plausible
    assert 0 < limit.told < 1

    def with_friction(name: str, force: float) -> Diagnosis:
        return found_in(campaign_of(tmp_path / name, lambda x, v: -force * np.tanh(v / 2e-3)))

    below = with_friction("half", 0.5 * limit.smallest)
    assert not any(effect.effect == "coulomb_friction" for effect in below.effects)
    above = with_friction("twice", 2.0 * limit.smallest)
    named = above.effects[0]
    assert "coulomb_friction" in {named.effect, *(name.split(" ")[0] for name in named.indistinguishable)}


@pytest.mark.parametrize(
    ("smallest", "largest", "words"),
    [
        (1400.0, 1400.0, "1.40 kN"),
        (340.0, 1200.0, "0.340 to 1.20 kN, by its shape"),
        (340.0, None, "340 N, or not, by its shape"),
        (None, None, "no size"),
    ],
)
def test_a_limit_in_words(smallest: float | None, largest: float | None, words: str) -> None:
    limit = file.DetectionLimit(smallest=smallest, largest=largest, plausible=1e4, told=0.2, unit="N")
    assert describe_limit(limit) == words


def test_an_effect_whose_limit_is_beyond_what_is_plausible_is_not_observable() -> None:
    def rejected(*smallest: float | None) -> file.RejectedEffect:
        limits = [file.DetectionLimit(smallest=size, largest=size, plausible=1.0, told=0.5, unit="N") for size in smallest]
        return file.RejectedEffect(effect="umbilical", reason="", detection_limits=dict(zip("ab", limits, strict=False)))

    assert not rejected(2.0, None).observable
    assert rejected(2.0, 0.5).observable  # one of its parameters would show it
    assert rejected().observable  # nothing is known of it
