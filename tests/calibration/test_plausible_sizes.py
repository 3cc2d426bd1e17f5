"""Plausible sizes of candidate effects: every label, Froude's similarity, and stated sizes in their place."""

from functools import cache
from types import SimpleNamespace

import jax
import numpy as np
import pytest
from numpy.testing import assert_allclose

import jaxhydro as jh
from calibration.campaign.stated_sizes import STATED_SIZES, is_about
from calibration.discovery.effects.candidates import TABLE_EFFECTS, Candidate, with_effects
from calibration.discovery.effects.catalogue import catalogue
from calibration.discovery.effects.catalogue_builder import noticeable_scales
from calibration.discovery.effects.plausible_sizes import PlausibleSize, plausible_sizes
from calibration.discovery.effects.reference_sizes import Case, Seas
from calibration.discovery.effects.size_ranges import reach_of
from jaxhydro.dynamics.model import Model
from jaxhydro.dynamics.statics import equilibrium, linearised
from jaxhydro.environment import DOFS
from jaxhydro.errors import InputError
from jaxhydro.loads.base import AbstractLoad, Action
from jaxhydro.parameters import parameter
from jaxhydro.platform.build import build
from jaxhydro.platform.schema import Platform
from jaxhydro.units import parse_unit

ROLL_ONLY = {
    "name": "a rolling ship at 1:68",
    "water": {"density": 1000.0, "depth": 5.0, "gravity": 9.81},
    "rigid_body": {"mass": 994.0, "centre_of_mass": [0.0, 0.0, 0.0], "inertia": {"Ixx": 115.7, "Iyy": 1376.0, "Izz": 1376.0}},
    "members": [],
    "added_mass": {"A44": 20.0},
    "linear_damping": {"B44": 3.0},
    "hydrostatics": {"C44": 822.0},
    "mooring": {"kind": "none"},
}
SPREAD = {"surge": 2.0, "heave": 0.5, "roll": 0.02, "pitch": 0.03}  # m, rad; of a platform of full size
LINES = [[150.0, 0.0], [-75.0, 130.0], [-75.0, -130.0]]  # m, anchors


def spar(size: float) -> Model:
    """A stout spar on three springs, lengths times `size`."""
    point = lambda *x: [size * coordinate for coordinate in x]  # noqa: E731
    member = {"name": "hull", "group": "hull", "shape": "circ", "d": 20.0 * size, "rA": point(0, 0, -40), "rB": point(0, 0, 10)}
    line = {"stiffness": 4e4 * size**2, "pretension": 2e5 * size**3}
    data = {
        "name": "spar",
        "water": {"density": 1000.0, "depth": 200.0 * size, "gravity": 9.81},
        "rigid_body": {
            "mass": 1.2566e7 * size**3,
            "centre_of_mass": point(0.0, 0.0, -25.0),
            "inertia": dict.fromkeys(("Ixx", "Iyy", "Izz"), 3e9 * size**5),
        },
        "members": [member],
        "coefficients": {"hull": {"Ca_t": 1.0, "Ca_z": 0.5, "Cd_t": 1.0, "Cd_z": 2.0}},
        "mooring": {
            "kind": "linear_springs",
            "lines": [
                {"anchor": point(*direction, -20.0), "fairlead": point(direction[0] / 15, direction[1] / 15, -20.0), **line}
                for direction in LINES
            ],
        },
    }
    return build(Platform.model_validate(data))


@cache
def case(name: str):
    """Model, candidates, noticeable sizes by motion, and seas."""
    size = 1 / 70 if name == "model scale" else 1.0
    if name == "one motion":
        model, spread = build(Platform.model_validate(ROLL_ONLY)), {"roll": 0.1}
    elif name == "semisubmersible":
        model, spread = jh.load_model("volturnus-s"), dict.fromkeys(DOFS, 0.1)
    else:
        model, spread = spar(size), {dof: s * size if dof in DOFS[:3] else s for dof, s in SPREAD.items()}
    waves = name not in ("one motion", "decays only")
    scales = noticeable_scales(*(np.asarray(matrix) for matrix in linearised(model, equilibrium(model))), spread)
    candidates = tuple(catalogue(model, scales, waves, size**2)[0])
    return model, candidates, scales, Seas(10.0 * size**0.5) if waves else None


@cache
def own_ranges(name: str) -> dict[str, PlausibleSize]:
    return plausible_sizes(*case(name), {})


def ranges(name: str, **stated) -> dict[str, PlausibleSize]:
    return plausible_sizes(*case(name), stated) if stated else own_ranges(name)


@cache
def with_all(name: str) -> Model:
    """The model with every candidate."""
    return with_effects(case(name)[0], list(own_ranges(name)))


CASES = ("semisubmersible", "full scale", "model scale", "decays only", "one motion")


@pytest.mark.parametrize("name", CASES)
def test_every_amplitude_has_a_range_about_its_neutral_value(name):
    """Within the bounds of its load, one-sided where physics is, with a source; no other label."""
    candidates, sizes = case(name)[1], ranges(name)
    assert set(sizes) == {label for candidate in candidates for label in candidate.amplitudes}
    for candidate in candidates:
        for label in candidate.amplitudes:
            size, about = sizes[label], with_all(name).about(label)
            assert size.lower <= about.neutral <= size.upper and about.neutral in size, label
            assert size.lower < size.upper and np.isfinite([size.lower, size.upper]).all(), label
            assert about.lower <= size.lower and size.upper <= about.upper, label
            assert label not in candidate.positive or size.lower == about.neutral, label
            assert size.source.endswith(".") and not size.stated
            assert size.source.startswith(
                ("engineering judgement: ", "IMO", "Graham", "Maruo", "Aranha", "OpenFAST", "Barrass")
            )


def test_without_waves_or_motions_what_they_make_is_absent():
    assert "wave_drift.surge.envelope" in ranges("full scale")
    assert not {"wave_drift.surge.envelope", "sensor_lag.delay"} & set(ranges("decays only"))
    assert {label.split(".")[1] for label in ranges("one motion") if label.startswith("hysteresis")} == {"roll"}
    model, candidates, scales, _ = case("full scale")
    with pytest.raises(ValueError, match="peak period of the waves"):
        plausible_sizes(model, candidates, scales, None, {})


def test_the_highest_sea_counts():
    """Of tests in waves that are used, in the band of first-order waves."""
    time = np.arange(0.0, 600.0, 0.5)

    def record(kind, use, height, period):
        wave = None if period is None else height * np.sin(2 * np.pi * time / period) + np.sin(2 * np.pi * time / 120.0)
        return SimpleNamespace(kind=kind, use=use, time=time, wave=wave)

    records = [record("irregular", "fit", 0.2, 8.0), record("irregular", "holdout", 0.9, 10.0)]
    uncounted = [record("decay", "fit", 9.0, 4.0), record("regular", "ignore", 9.0, 5.0), record("regular", "fit", 0.0, None)]
    assert Seas.of([*records, *uncounted], low=0.03).peak_period == pytest.approx(10.0, rel=0.01)
    assert Seas.of(records).peak_period > 20.0  # s, with the slow waves below that band
    assert Seas.of(uncounted) is None


def test_by_froude_a_model_has_the_same_numbers():
    """Lengths go with the size, times with its root, masses with its cube; the weight of a drift with omega squared, too."""
    large, small = ranges("full scale"), ranges("model scale")
    assert set(large) == set(small)
    for label in large:
        length, mass, time, _ = parse_unit(with_all("full scale").about(label).unit).powers
        factor = (1 / 70) ** (length + 3 * mass + time / 2 + label.endswith("frequency_weighted"))
        expected = np.array([large[label].lower, large[label].upper])
        about = 1.0 if label.startswith(("wave_excitation", "sea_state")) else 0.0
        assert_allclose([small[label].lower - about, small[label].upper - about], (expected - about) * factor, rtol=1e-6)


def test_sizes_of_a_semisubmersible():
    """Of 20 000 t: what the sources say, in numbers."""
    sizes = ranges("semisubmersible")
    point = sizes["sensor_reference.z"]
    assert (point.lower, point.upper) == pytest.approx((-23.5, 18.5))  # m: keel and deck, and a tenth of 35 m beyond
    assert sizes["mass_properties.mass"].upper == pytest.approx(0.02 * float(case("semisubmersible")[0].body.mass))
    assert sizes["mass_properties.centre_z"].upper == pytest.approx(0.5, rel=0.01)
    assert sizes["wave_gauge_position.distance"].upper == pytest.approx(8.0, rel=0.01)
    assert sizes["wave_drift.surge.envelope"].upper == pytest.approx(0.5 * 1025 * 9.81 * 27, rel=0.02)
    assert (sizes["wave_excitation.column.Cp_t"].lower, sizes["wave_excitation.column.Cp_t"].upper) == (0.6, 1.4)
    assert -1 / 3 in sizes["amplitude_dependent_drag.column.exponent"]
    assert 1.5 not in sizes["sea_state_dependent_drag.low_share"]
    friction, scales = sizes["coulomb_friction.surge.force"], case("semisubmersible")[2]["surge"]
    assert friction.upper == pytest.approx(0.1 * 2.5 * scales.force / 0.02)  # of the force at 2.5 times the amplitude


def test_terms_of_the_equation_have_ranges_too():
    """Linear damping, stiffness and added mass, on and beside the diagonal, whether the catalogue has them or not."""
    reference = Case(case("decays only")[0], case("decays only")[2], None)
    terms = {"linear_damping": "B", "quadratic_damping": "B", "stiffness": "C", "added_mass": "A"}
    for term, letter in terms.items():
        own, beside = (reach_of(reference, f"{term}.{letter}{entry}") for entry in ("11", "15"))
        assert own.above > 0 and own.whole > 0
        assert -beside.below == beside.above > 0
        assert own.below == (0.0 if letter == "B" else -own.above)  # damping takes energy


@pytest.mark.parametrize("effect", TABLE_EFFECTS)
def test_tables_that_a_platform_file_requests_have_ranges_too(effect):
    reach = reach_of(Case(*case("full scale")[::2], None), f"{effect}.share")
    assert (reach.below, reach.above, reach.whole) == (0.0, 1.3, 1.0)


def test_a_body_without_members_is_as_large_as_the_water_that_it_displaces():
    ship = Case(case("one motion")[0], {}, None)
    assert ship.hull_extent(2) == pytest.approx((-0.499, 0.499), abs=1e-3)  # m, half the cube root of 0.994 m3
    assert Case(case("full scale")[0], {}, None).hull_extent(2) == pytest.approx((-40.0, 11.6), abs=0.1)


class Spring(AbstractLoad):
    """A spring of one's own."""

    k: jax.Array = parameter("N/m", "spring in heave", 0.0)
    slant: jax.Array = parameter("N", "pull in heave")

    def act(self, now, memory):
        return Action(force=now.position * 0.0)


def test_of_ones_own_effect():
    """As many noticeable sizes as its prior has had, within its bounds; or as stated."""
    model, _, scales, _ = case("decays only")
    own = Candidate("spring", None, ("spring.k", "spring.slant"), load=Spring(), sizes={"spring.k": 10.0, "spring.slant": 2.0})
    sizes = plausible_sizes(model, [own], scales, None, {})
    assert [(sizes[k].lower, sizes[k].upper) for k in own.amplitudes] == [(0.0, 300.0), (-60.0, 60.0)]


def test_a_label_that_no_rule_knows_is_an_error():
    model, _, scales, _ = case("decays only")
    with pytest.raises(KeyError, match=r"no plausible size of umbilical\.height"):
        plausible_sizes(model, [Candidate("umbilical", None, ("umbilical.height",))], scales, None, {})


@pytest.mark.parametrize("key", STATED_SIZES)
def test_a_short_key_has_the_units_of_its_labels(key):
    """Those of the loads, %, where there is a whole; and some catalogue has labels that it is about."""
    units = {parse_unit(unit).powers for unit in STATED_SIZES[key][1] if unit != "%"}
    labels = [label for label in ranges("semisubmersible") if is_about(key, label)]
    tables = ("computed_excitation", "computed_radiation", "computed_added_mass", "diffraction_correction", "drift_transfer")
    later = ("linear_damping", "stiffness", "added_mass", *tables)
    assert labels or key in later
    powers = {parse_unit(with_all("semisubmersible").about(label).unit).powers for label in labels}
    assert not units or powers <= units
    if labels and "%" in STATED_SIZES[key][1]:
        model, candidates, scales, seas = case("semisubmersible")
        concerned = [candidate for candidate in candidates if set(labels) & set(candidate.amplitudes)]
        assert any(size.stated for size in plausible_sizes(model, concerned, scales, seas, {key: "5 %"}).values())


def test_stated_sizes_take_the_place_of_ours():
    """Shares of what is declared; quantities in any unit; the closest key counts; other motions and signs stay as they are."""
    stated = {
        "mass": "3 %",
        "inertia": "2 %",
        "centre": "30 cm",
        "wave_gauge": "2 m",
        "tracked_point": "20 m",
        "clock": "200 ms",
        "current": "0.1 m/s",
        "coulomb_friction": "50 kN",
        "coulomb_friction.roll": "5 %",
        "wave_drift.surge.envelope": "100 kN/m^2",
        "wave_excitation": "10 %",
        "umbilical.pull": 7.0,
        "sea_state_dependent_drag": "50 %",
        "hysteresis.surge.force": "3 kN",
        "hysteresis": "1 %",
    }
    ours, stated_sizes = ranges("full scale"), ranges("full scale", **stated)
    model = case("full scale")[0]
    expected = {
        "mass_properties.mass": (-0.03 * float(model.body.mass), 0.03 * float(model.body.mass)),
        "mass_properties.inertia_pitch": (-0.02 * float(model.body.inertia[1, 1]), 0.02 * float(model.body.inertia[1, 1])),
        "mass_properties.centre_x": (-0.3, 0.3),
        "mass_properties.centre_z": (-0.3, 0.3),
        "wave_gauge_position.distance": (-2.0, 2.0),
        "sensor_reference.z": (-20.0, 20.0),
        "sensor_lag.delay": (-0.2, 0.2),
        "current.x": (-0.1, 0.1),
        "coulomb_friction.surge.force": (0.0, 5e4),
        "coulomb_friction.heave.force": (0.0, 5e4),
        "coulomb_friction.roll.force": (0.0, 0.5 * ours["coulomb_friction.roll.force"].upper),
        "wave_drift.surge.envelope": (-1e5, 1e5),
        "wave_excitation.hull.Cp_t": (0.9, 1.1),
        "umbilical.pull": (-7.0, 7.0),
        "sea_state_dependent_drag.low_share": (0.5, 1.0),
        "hysteresis.pitch.force": (0.0, ours["hysteresis.pitch.force"].upper / 15),
        "hysteresis.surge.force": (0.0, 3e3),
    }
    for label, (lower, upper) in expected.items():
        assert_allclose([stated_sizes[label].lower, stated_sizes[label].upper], [lower, upper], rtol=1e-9, err_msg=label)
        assert stated_sizes[label].stated and stated_sizes[label].source.startswith("stated in campaign.yaml, plausible.")
    assert stated_sizes["coulomb_friction.pitch.force"] == ours["coulomb_friction.pitch.force"]  # a moment is no force
    assert stated_sizes["wave_drift.surge.quadrature"] == ours["wave_drift.surge.quadrature"]
    assert stated_sizes["hysteresis.surge.force"].source == "stated in campaign.yaml, plausible.hysteresis.surge.force."


def test_what_is_no_candidate_may_be_stated():
    """One manifest serves decays and seas."""
    assert ranges("full scale", sensor_lag="0.2 s")["sensor_lag.delay"] == PlausibleSize(
        -0.2, 0.2, "stated in campaign.yaml, plausible.sensor_lag.", True
    )  # by the effect's own name
    assert ranges("decays only", **{"wave_gauge": "2 m", "wave_drift.surge.envelope": 1e5}) == ranges("decays only")


@pytest.mark.parametrize(
    ("stated", "message"),
    [
        (
            {"coulomb_friction.surge.forse": 1.0},
            "expected a parameter of this effect .*Did you mean 'coulomb_friction.surge.force'",
        ),
        ({"coulomb_friction.sway.force": 1.0}, "expected a parameter of this effect .*found 'coulomb_friction.sway.force'"),
        ({"wave_drift.surge.envelope": "3 m"}, r"wave_drift.surge.envelope: expected a quantity in N/m2 or %, found '3 m'"),
        ({"sensor_lag.delay": "3 %"}, "sensor_lag.delay: expected a quantity in s, found '3 %'"),
    ],
)
def test_a_label_that_is_wrong_is_told(stated, message):
    with pytest.raises(InputError, match=f"campaign.yaml: plausible.*{message}"):
        plausible_sizes(*case("full scale"), stated)
