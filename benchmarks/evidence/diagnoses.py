"""Section: what `diagnose` says of campaigns whose missing effect is known, or that miss nothing."""

import json
import shutil
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any, NamedTuple

from benchmarks.evidence.common import CACHE, ROOT, Section, fingerprint, parallel, say, table

TITLE = "What is missing: diagnoses of campaigns from an independent tank"
EFFECTS = (
    "umbilical", "coulomb_friction", "hysteresis", "mooring_nonlinearity", "radiation_memory", "current",
    "amplitude_dependent_drag", "sea_state_dependent_drag", "wave_drift", "wave_drift_damping", "hidden_oscillator",
    "nonlinear_hydrostatics", "coupled_damping", "mass_properties", "sensor_reference", "sensor_lag", "wave_gauge_position",
    "wave_reflection",
)  # fmt: skip
OUTSIDE = ("stiffness_drift", "end_stop", "cogging")  # no candidate has these laws
SEEDS, NULLS = 3, 20
STRENGTHS = {1: "weak", 2: "middle", 3: "strong"}
NAMED, IN_SET, FALSE_ALARMS = 0.90, 0.97, 0.05  # goals


class Case(NamedTuple):
    """A campaign: an effect at a strength, or nothing missing (""), of a seed."""

    effect: str
    strength: int
    seed: int

    @property
    def name(self) -> str:
        return f"{self.effect}-{self.strength}-{self.seed}" if self.effect else f"nothing-{self.seed}"

    @classmethod
    def of(cls, name: str) -> "Case":
        parts = name.split("-")
        return cls("", 2, int(parts[1])) if parts[0] == "nothing" else cls(parts[0], int(parts[1]), int(parts[2]))


def cases() -> Iterator[Case]:
    """All of them, so that any few from the front tell something: the middle strength first, nothing missing in between."""
    nulls = iter([Case("", 2, seed) for seed in range(1, NULLS + 1)])
    for strength, seed in ((2, 1), (2, 2), (2, 3), (3, 1), (1, 1), (3, 2), (1, 2), (3, 3), (1, 3)):
        for i, effect in enumerate((*EFFECTS, *OUTSIDE)):
            if i % 5 == 0 and (null := next(nulls, None)) is not None:
                yield null
            yield Case(effect, strength, seed)


def folder_of(name: str) -> Path:
    return CACHE / "diagnosed-campaigns" / name


def made(names: Sequence[str]) -> None:
    """Make the campaigns that are not there yet, those of one seed together: they share seas."""
    from benchmarks.tank import Spec, make_campaigns

    missing = [case for name in names if not (folder_of(name) / "truth.json").exists() for case in [Case.of(name)]]
    for seed in sorted({case.seed for case in missing}):
        some = [case for case in missing if case.seed == seed]
        for case in some:
            shutil.rmtree(folder_of(case.name), ignore_errors=True)
        truths = make_campaigns([Spec(folder_of(c.name), c.effect or None, c.strength, seed) for c in some])
        for case, truth in zip(some, truths, strict=True):  # written last
            (folder_of(case.name) / "truth.json").write_text(json.dumps(truth, default=float))
        say(f"  seed {seed}: {len(some)} campaigns made")


def of_case(name: str) -> dict[str, Any]:
    """What a diagnosis says of one campaign."""
    from calibration.campaign import load_campaign
    from calibration.discovery.search import diagnose

    campaign = load_campaign(folder_of(name))
    result = diagnose(campaign.model, campaign)
    first = result.effects[0] if result.effects else None
    return {
        "verdict": result.verdict,
        "effects": [one.effect for one in result.effects],
        "motions": [one.degree_of_freedom for one in result.effects],
        "alike": [text.split(" ")[0] for text in first.indistinguishable] if first else [],
        "evidence": [[e.delta_bic, e.holdout_gain, e.clear] for e in (one.evidence for one in result.effects)],
        "error": [result.baseline.objective("holdout"), result.augmented.objective("holdout")],
        "refused": {f"{one.effect} {one.degree_of_freedom or ''}".strip(): one.reason for one in result.rejected},
        "left": [[one.test, one.use, one.channel, one.rms, one.noise, one.relative, one.bands] for one in result.anatomy_after],
        "seconds": result.seconds,
    }  # fmt: skip


def outcome(case: Case, result: dict[str, Any]) -> str:
    """named: the right one first; in the set: among those that cannot be told from the first; else what was said."""
    if not result["effects"]:
        return "nothing" if result["verdict"] == "nothing_missing" else "unexplained"
    if not case.effect:
        return "false alarm"
    if result["effects"][0] == case.effect:
        return "named"
    return "in the set" if case.effect in result["alike"] or case.effect in result["effects"] else "another"


def run(figures: Path, processes: int, most: int) -> Section:
    """The first `most` cases."""
    names = [case.name for case in cases()][:most]
    made(names)
    tank = [ROOT / "benchmarks" / name for name in ("tank.py", "tank_effects.py", "reference_model.py", "reference_waves.py")]
    results: dict[str, dict[str, Any]] = {}
    key = fingerprint(*tank)
    for name, result in parallel("diagnoses", key, names, of_case, processes, go_on=True):
        results[name] = result
        found = ", ".join(result["effects"]) or result["verdict"]
        say(f"  {name}: {found} ({result['seconds']:.0f} s, {len(results)} of {len(names)})")
    here = sum((CACHE / "diagnoses" / key / f"{name}.json").exists() for name in results)
    return conclude({Case.of(name): results[name] for name in names if name in results}, len(results) - here)


def share(count: int, of: int) -> str:
    return f"{count} of {of}"


def conclude(results: dict[Case, dict[str, Any]], earlier: int) -> Section:
    """The tables and what falls short; so many results are of `earlier` sources."""
    said = {case: outcome(case, result) for case, result in results.items()}
    nulls = [said[case] for case in said if not case.effect]
    middle = [said[case] for case in said if case.effect in EFFECTS and case.strength == 2]
    rows = []
    for effect in (*EFFECTS, *OUTSIDE):
        cells = []
        for strength in STRENGTHS:
            mine = [case for case in said if (case.effect, case.strength) == (effect, strength)]
            cells.append(", ".join(_words(said[case], results[case]) for case in mine) or "–")
        rows.append((f"`{effect}`" + (" (outside)" if effect in OUTSIDE else ""), *cells))
    named, listed = middle.count("named"), middle.count("named") + middle.count("in the set")
    alarms = nulls.count("false alarm")
    total = sum(1 for _ in cases())
    by = f", {earlier} of them by earlier sources" if earlier else ""
    text = (
        f"Nine decays and two seas of 1600 s each, from `benchmarks/tank.py`, a plain NumPy tank that shares no code with the "
        f"package: noise, imperfect releases, mass and mooring not quite as declared. {len(results)} of {total} campaigns were "
        f"run{by}. At the middle strength the right effect is named first in {share(named, len(middle))}, and among those told "
        f"apart by nothing in {share(listed, len(middle))}; of campaigns with nothing missing {share(alarms, len(nulls))} "
        f"raised a false alarm.\n\n"
        f"What was said, seed by seed (*nothing*: nothing missing; a name: that effect instead; in brackets, what else was "
        f"added):\n\n" + table(("effect in the tank", *STRENGTHS.values()), rows)
    )  # fmt: skip
    if nulls:
        text += f"\nOf nothing missing: {', '.join(_words(said[case], results[case]) for case in said if not case.effect)}.\n"
    short = []
    if middle and named < NAMED * len(middle):
        short.append(f"diagnosis: named first in {share(named, len(middle))}, goal {100 * NAMED:.0f} %")
    if middle and listed < IN_SET * len(middle):
        short.append(f"diagnosis: in the set in {share(listed, len(middle))}, goal {100 * IN_SET:.0f} %")
    if nulls and alarms > FALSE_ALARMS * len(nulls):
        short.append(f"diagnosis: false alarms in {share(alarms, len(nulls))}, goal 1 of 20")
    if len(results) < total:
        short.append(f"diagnosis: {len(results)} of {total} campaigns run")
    return Section(TITLE, text, (), tuple(short))


def _words(said: str, result: dict[str, Any]) -> str:
    """An outcome in a cell."""
    effects = result["effects"]
    if not effects:
        return f"*{said}*"
    first = "named" if said == "named" else f"{effects[0]} or it" if said == "in the set" else effects[0]
    return first + (f" [{', '.join(effects[1:])}]" if len(effects) > 1 else "")
