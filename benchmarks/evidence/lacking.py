"""Section: what `diagnose` says of measured records: what the baselines lack, errors before and after."""

import json
import shutil
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.evidence import common
from benchmarks.evidence.common import CACHE, SHARED, Section, fingerprint, parallel, require, say, table, within
from calibration.formatting import number, percent

TITLE = "What models of measured bodies lack"
MEASURED = SHARED / "measured"
CASES = {
    "kvlcc2": "KVLCC2, roll decay, linear restoring declared",
    "focal-c4": "FOCAL campaign 4, release from a surge offset",
    "focal-c2": "FOCAL campaign 2, three seas, the highest held out",
    "focal-c2-tables": "FOCAL campaign 2, the hull's WAMIT tables (`radiation`, `excitation`, `drift`) among the candidates",
}
DRAWN = "focal-c2"
SHOWN = 1500.0  # s, of the sea that was held out
TABLES = {"radiation": "semi.1", "excitation": "semi.3", "drift": "semi.12d"}
MOTIONS = ("surge", "heave", "pitch")
BANDS = {"low_frequency": "low", "wave_frequency": "wave"}
AIMS = {("surge", "low_frequency"): 0.15, ("heave", "low_frequency"): 0.15, ("pitch", "low_frequency"): 0.3}
AIM, FOLLOWED = 0.1, 0.9  # of energies at wave frequency; correlation of slow surge
PAPER = {"low_frequency": (0.21, -0.67, -0.74), "wave_frequency": (-0.32, 0.10, 0.06)}  # its best case, of surge, heave, pitch


def campaign_of(name: str) -> Path:
    """The campaign's folder; one with tables is made in the cache."""
    if not name.endswith("-tables"):
        return MEASURED / name
    folder = CACHE / "lacking-campaigns" / name
    folder.mkdir(parents=True, exist_ok=True)
    for path in (MEASURED / name.removesuffix("-tables")).iterdir():
        shutil.copy(path, folder)
    lines = []
    for key, file in TABLES.items():
        shutil.copy(MEASURED / "focal-c4" / "wamit" / file, folder)
        lines.append(f"{key}: {{file: {file}, use: candidate}}")
    with open(folder / "platform.yaml", "a", encoding="utf-8") as platform:
        platform.write("\n" + "\n".join(lines) + "\n")
    return folder


def key() -> str:
    """Key of the section's results."""
    return fingerprint(*(MEASURED / name for name in ("kvlcc2", "focal-c4", "focal-c2")))


def written_to(name: str) -> Path:
    """Where a diagnosis of these sources is written; one that was killed goes on there."""
    return CACHE / "lacking-results" / key() / name


def work(name: str) -> dict[str, Any]:
    """A campaign diagnosed, as the command line does it, and what its files say."""
    from calibration.campaign.load_campaign import load_campaign
    from calibration.discovery.checkpoint import CHECKPOINT_FILE
    from calibration.discovery.diagnose import diagnose
    from calibration.results.result_folder import DIAGNOSIS_FILE
    from calibration.results.write_diagnosis import write_diagnosis

    folder = written_to(name)
    folder.mkdir(parents=True, exist_ok=True)
    if not (folder / DIAGNOSIS_FILE).exists():
        campaign = load_campaign(campaign_of(name))
        write_diagnosis(diagnose(campaign.model, campaign, checkpoint=folder / CHECKPOINT_FILE), folder, figures=False)
        (folder / CHECKPOINT_FILE).unlink(missing_ok=True)
    return numbers(folder, name)


def numbers(folder: Path, name: str) -> dict[str, Any]:
    """What a folder of results says, and how well slow motions are followed in time."""
    import xarray as xr

    from calibration.campaign.load_campaign import load_campaign
    from calibration.results.result_folder import DIAGNOSIS_FILE
    from jaxhydro.analysis.motion_bands import bands

    diagnosis = json.loads((folder / DIAGNOSIS_FILE).read_text())
    tests = load_campaign(campaign_of(name)).manifest.tests
    periods = {test.id: test.peak_period for test in tests if test.kind == "irregular"}
    correlation: dict[str, Any] = {}
    with xr.open_dataset(folder / "simulated.nc") as motion:
        step = float(np.diff(motion.time.values[:2])[0])
        for test in [str(x) for x in motion.test.values if str(x) in periods]:
            for dof in MOTIONS:
                low, high = bands(dof, periods[test])["low_frequency"]
                slow = {
                    k: within(motion[k].sel(test=test, channel=dof).values, low, high, step)
                    for k in ("measured", "before", "simulated")
                }
                pair = [float(np.corrcoef(slow["measured"], slow[k])[0, 1]) for k in ("before", "simulated")]
                correlation.setdefault(test, {})[dof] = pair
    copied = ("missing", "baseline", "augmented", "tests", "notes", "seconds", "next_test")
    return {k: diagnosis[k] for k in copied} | {"correlation": correlation}


def run(figures: Path, processes: int) -> Section:
    """All campaigns; the longest first."""
    require(MEASURED, "the measured records (../shared/measured) are not on this machine")
    results = {}
    for name, result in parallel("lacking", key(), list(CASES)[::-1], work, processes):
        results[name] = result
        names = [effect["effect"] for effect in result["missing"]["effects"]]
        say(f"  {name}: {', '.join(names) or result['missing']['verdict']} ({result['seconds']:.0f} s)")
    results = {name: results[name] for name in CASES}
    path = figures / "focal-closed.png"
    if not common.text_only or (written_to(DRAWN) / "simulated.nc").exists():
        draw(DRAWN, path)
    text = "\n".join(f"### {CASES[name]}\n\n{words(result)}" for name, result in results.items())
    return Section(TITLE, intro() + text, (path,), tuple(s for name, result in results.items() for s in short_of(name, result)))


def draw(name: str, path: Path) -> None:
    """Slow surge and pitch in the sea that was held out: measured, of the baseline fitted, and with what was found."""
    import xarray as xr

    from calibration.campaign.load_campaign import load_campaign
    from jaxhydro.analysis.motion_bands import bands
    from jaxhydro.plots.style import BEFORE, MEASURED, SIMULATED, header, save, stack, style
    from jaxhydro.units import unit_of

    campaign = load_campaign(campaign_of(name))
    held = next(test for test in campaign.manifest.tests if test.use == "holdout" and test.kind == "irregular")
    looks = {"measured": (MEASURED, 1.3), "before": (BEFORE, 1.0), "simulated": (SIMULATED, 0.8)}
    names = {"measured": "measured", "before": "baseline", "simulated": "with what was found"}
    with xr.open_dataset(written_to(name) / "simulated.nc") as motion, style():
        motions = motion.sel(test=held.id)
        time = motions.time.values - motions.time.values[0]
        figure, axes = stack([1.0, 1.0])
        artists = {}
        for ax, dof in zip(axes, ("surge", "pitch"), strict=True):
            low, high = bands(dof, held.peak_period)["low_frequency"]
            for kind, (colour, width) in looks.items():
                values = within(motions[kind].sel(channel=dof).values, low, high, float(time[1] - time[0]))
                shown = time[: len(values)] < SHOWN
                (artists[names[kind]],) = ax.plot(time[: len(values)][shown], values[shown], color=colour, lw=width)
            ax.set_ylabel(f"Slow {dof} ({unit_of(dof)})")
        axes[-1].set_xlabel("Time (s)")
        header(figure, f"FOCAL campaign 2, {held.id}, which was not fitted", artists, columns=3)
        save(figure, path)


def intro() -> str:
    return (
        "Errors in waves are (simulated - measured) / measured, of energies in the paper's bands. *Before* is the model of the "
        "platform file, fitted to the same records. The paper's best case (IFAC MECC 2025, Sarker et al.) has the same hull "
        "with its coefficients tuned to decays. Its errors in surge, heave and pitch are: "
        + "; ".join(f"{BANDS[band]} frequency " + ", ".join(f"{100 * x:+.0f} %" for x in row) for band, row in PAPER.items())
        + ".\n\n"
    )


def words(diagnosis: dict[str, Any]) -> str:
    """A campaign's part of the section."""
    missing = diagnosis["missing"]
    share = percent(missing["unexplained"]["share"])
    took = f"{diagnosis['seconds'] / 60:.0f} minutes" if diagnosis["seconds"] > 90 else f"{diagnosis['seconds']:.0f} s"
    text = f"Verdict: *{missing['verdict'].replace('_', ' ')}*, {took}. "
    text += f"{share} of the error's energy is left: {missing['unexplained']['signature'].rstrip('.')}.\n\n"
    # but for the name of a file
    notes = [note if "." in note.split(",")[0] else note[0].upper() + note[1:] for note in diagnosis["notes"]]
    text += "".join(f"{note.rstrip('.')}.\n\n" for note in notes)
    if missing["effects"]:
        head = ("Found", "Parameter", "Value ± 1 sd", "BIC falls by", "Held-out gain", "Cannot be told from")
        text += table(head, effects(diagnosis)) + "\n"
    if decays := decay_rows(diagnosis):
        text += table(("Decay", "use", "RMSE over sd, before", "after"), decays) + "\n"
    if seas := sea_rows(diagnosis):
        text += (
            table(
                (
                    "Sea",
                    "use",
                    "Motion",
                    "Low, before",
                    "after",
                    "Wave, before",
                    "after",
                    "RMSE over sd, before",
                    "after",
                    "Slow motion's correlation, before",
                    "after",
                ),
                seas,
            )
            + "\n"
        )
    return text


def effects(diagnosis: dict[str, Any]) -> list[tuple[str, ...]]:
    """A row for every parameter of what was found."""
    rows = []
    for effect in diagnosis["missing"]["effects"]:
        evidence = effect["evidence"]
        gain = "–" if evidence["holdout_gain"] is None else percent(evidence["holdout_gain"])
        head = (" ".join(filter(None, (f"`{effect['effect']}`", effect["degree_of_freedom"]))),)
        tail = (number(evidence["delta_bic"], 3), gain, ", ".join(effect["indistinguishable_from"]) or "–")
        for i, (name, value) in enumerate(effect["parameters"].items()):
            deviation = value["standard_deviation"]
            about = "" if deviation is None else f" ± {number(deviation, 1)}"
            size = f"{number(value['value'], 3)}{about} {value['unit']}"
            rows.append((*(head if i == 0 else ("",)), name, size, *(tail if i == 0 else ("", "", ""))))
    return rows


def stages(diagnosis: dict[str, Any]) -> list[dict[str, Any]]:
    """Errors by test before and after."""
    return [diagnosis[k]["error"] for k in ("baseline", "augmented")]


def decay_rows(diagnosis: dict[str, Any]) -> list[tuple[str, ...]]:
    before, after = stages(diagnosis)
    rows = []
    for test, errors in before.items():
        for channel, error in errors.items():
            if test not in diagnosis["correlation"] and isinstance(error, dict) and error.get("in_objective"):
                ratios = (percent(error["relative"]), percent(after[test][channel]["relative"]))
                rows.append((f"{test}, {channel}", errors["use"], *ratios))
    return rows


def sea_rows(diagnosis: dict[str, Any]) -> list[tuple[str, ...]]:
    before, after = stages(diagnosis)
    rows = []
    for test, pairs in diagnosis["correlation"].items():
        for dof in MOTIONS:
            stage_errors = (before[test], after[test])
            cells = [f"{100 * errors['bands'][dof][band]:+.0f} %" for band in BANDS for errors in stage_errors]
            cells += [percent(errors[dof]["relative"]) for errors in stage_errors] + [f"{x:.2f}" for x in pairs[dof]]
            rows.append((test, before[test]["use"], dof, *cells))
    return rows


def short_of(name: str, diagnosis: dict[str, Any]) -> list[str]:
    """What falls short of the aims in seas that were not fitted."""
    short = []
    for test, pairs in diagnosis["correlation"].items():
        after = diagnosis["augmented"]["error"][test]
        if after["use"] != "holdout":
            continue
        off = [
            f"{dof} {BANDS[band]} {100 * error:+.0f} %"
            for dof in MOTIONS
            for band, error in after["bands"][dof].items()
            if abs(error) > AIMS.get((dof, band), AIM)
        ]
        if off:
            short.append(f"{name}, {test}: {', '.join(off)}")
        if pairs["surge"][1] < FOLLOWED:
            short.append(f"{name}, {test}: correlation of slow surge {pairs['surge'][1]:.2f}, aim {FOLLOWED:g}")
    return short
