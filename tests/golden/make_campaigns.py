"""Write the campaigns of the golden set: decays and a short sea of the synthetic wave tank, thinned to keep the files small.

    python -m tests.golden.make_campaigns

`complete` has nothing missing; `friction` has Coulomb friction that its platform file does not know. Made once: the golden
numbers belong to these files.
"""

from pathlib import Path

from ruamel.yaml import YAML

from benchmarks import tank

FOLDER = Path(__file__).parent / "campaigns"
DECAYS = ("heave-1", "heave-2", "pitch-1", "pitch-2")
SEA_DURATION, SEA_TRANSIENT = 500.0, 150.0  # s
EVERY = 2  # samples, of those that the tank writes
HELD_OUT = "pitch-2"


def main() -> None:
    """Write both campaigns."""
    for name, effect, tests in (
        ("complete", None, (*DECAYS, "sea-1")),
        ("friction", "coulomb_friction:pitch", DECAYS),
    ):
        setup = tank.Setup(tank.Spec(FOLDER / name, effect, 2, seed=7))
        (records,) = tank.simulate([setup], tests)
        if "sea-1" in records:
            records["sea-1"] = records["sea-1"][: round(SEA_DURATION / tank.STEP)]
        tank.write(setup, records, FOLDER / name)
        for test in tests:
            path = FOLDER / name / f"{test}.csv"
            header, *rows = path.read_text().splitlines()
            path.write_text("\n".join([header, *rows[::EVERY]]) + "\n")
        yaml = YAML()
        manifest = yaml.load(FOLDER / name / "campaign.yaml")
        manifest["name"] = f"golden-{name}"
        for test in manifest["tests"]:
            test["use"] = "holdout" if test["id"] == HELD_OUT else "fit"
            if test["kind"] == "irregular":
                test["transient"] = SEA_TRANSIENT
        yaml.dump(manifest, FOLDER / name / "campaign.yaml")


if __name__ == "__main__":
    main()
