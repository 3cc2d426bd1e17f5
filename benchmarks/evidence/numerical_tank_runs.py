"""OpenFAST's potential-flow runs as a campaign of measurements, its calibration and its diagnoses."""

import json
import shutil
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import yaml

from benchmarks.evidence.common import CACHE, SHARED
from benchmarks.evidence.openfast_runs import FOLDER, platform

NAME = "numerical_tank"
CAMPAIGN = CACHE / "numerical-tank-campaign"
WITH_TABLES = CACHE / "numerical-tank-with-tables"  # the same campaign, the tank's own tables among the candidates
HYDRO = SHARED / "reference" / "iea15-umaine" / "HydroData" / "IEA-15-240-RWT-UMaineSemi.1"
TABLES = {"radiation": ".1", "excitation": ".3", "drift": ".12d"}
DECAYS = ("surge", "heave", "pitch")
SEA, REST = "ss1_nwt", "nwt_static"
RUNS = (*(f"decay_{dof}_nwt" for dof in DECAYS), SEA, REST)
COLUMNS = {"surge_m": "PtfmSurge", "heave_m": "PtfmHeave", "pitch_deg": "PtfmPitch"}
NOISE = {"surge": 0.01, "heave": 0.005, "pitch": 0.01}  # m, m, deg: the contract's
EVERY = 5  # of OpenFAST's samples, 0.1 s apart
TRANSIENT, HALF, END = 300.0, 2100.0, 3900.0  # s: of the sea, the fitted half's end, the held-out one's
PERIOD = 8.96  # s
FITTED, HELD = "sea-fitted", "sea-held-out"
SHOWN = 2  # samples between those that are drawn


def columns(name: str) -> dict[str, np.ndarray]:
    """The table of one of OpenFAST's runs."""
    import pandas as pd

    data = pd.read_csv(FOLDER / name / "out.csv.gz", skiprows=[1]).astype(float)
    return {key: data[key].to_numpy() for key in data}


def setup() -> dict[str, Any]:
    """Numbers of the strip model that is declared."""
    return json.loads((FOLDER / "decay_surge_strip" / "setup.json").read_text())


def written() -> Path:
    """The campaign's folder: the strip model as declared, and the runs with a sensor's noise."""
    CAMPAIGN.mkdir(parents=True, exist_ok=True)
    random = np.random.default_rng(0)
    for name in RUNS:
        table = {key: values[::EVERY] for key, values in columns(name).items()}
        noisy = {
            name: table[column] + NOISE[name.split("_")[0]] * random.standard_normal(len(table[column]))
            for name, column in COLUMNS.items()
        }
        series = {"time_s": table["Time"], **noisy, "wave_m": table["Wave1Elev"]}
        head = ",".join(series)
        np.savetxt(CAMPAIGN / f"{name}.csv", np.stack([*series.values()], axis=1), "%.6g", ",", header=head, comments="")
    sea = {"kind": "irregular", "file": f"{SEA}.csv", "significant_wave_height": 3.1, "peak_period": PERIOD}
    units = {"time": "s", "surge": "m", "heave": "m", "pitch": "deg"}
    manifest = {
        "name": "numerical wave tank",
        "platform": "platform.yaml",
        "channels": {name: {"column": f"{name}_{unit}", "unit": unit} for name, unit in units.items()},
        "wave_channel": {"column": "wave_m", "unit": "m", "position": [0.0, 0.0]},
        "noise": NOISE,
        "zero": {"test": "rest"},
        "records": {"order": 1},
        "tests": [
            {"id": "rest", "kind": "static", "file": f"{REST}.csv", "use": "ignore"},
            *({"id": dof, "kind": "decay", "degree_of_freedom": dof, "file": f"decay_{dof}_nwt.csv"} for dof in DECAYS),
            {"id": FITTED, **sea, "window": [0.0, HALF], "transient": TRANSIENT},
            {"id": HELD, **sea, "window": [HALF, END], "use": "holdout"},
        ],
    }
    (CAMPAIGN / "campaign.yaml").write_text(yaml.safe_dump(manifest, sort_keys=False))
    # ExctnDisp is 0 in the tank's runs: waves do not tell where the platform has gone
    document = {**platform(setup()), "name": "VolturnUS-S by strips", "waves_at": "mean"}
    (CAMPAIGN / "platform.yaml").write_text(yaml.safe_dump(document, sort_keys=False))
    return CAMPAIGN


def written_with_tables() -> Path:
    """Folder of the same campaign with WAMIT's tables, of which the tank's forces are made, as candidates."""
    WITH_TABLES.mkdir(parents=True, exist_ok=True)
    for path in (*sorted(CAMPAIGN.glob("*.csv")), CAMPAIGN / "campaign.yaml"):
        shutil.copy(path, WITH_TABLES)
    tables = {}
    for key, ending in TABLES.items():
        shutil.copy(HYDRO.with_suffix(ending), WITH_TABLES / f"hull{ending}")
        tables[key] = {"file": f"hull{ending}", "use": "candidate"}
    document = yaml.safe_load((CAMPAIGN / "platform.yaml").read_text())
    (WITH_TABLES / "platform.yaml").write_text(yaml.safe_dump(document | tables, sort_keys=False))
    return WITH_TABLES


def errors_of(result: Any) -> dict[str, Any]:
    """Errors by test: RMSE over the standard deviation by motion, and of energies by motion and band."""
    return {
        test.id: {
            "use": test.use,
            "relative": {series.channel: series.relative for series in test.series},
            "mean": {series.channel: [float(series.measured.mean()), float(series.simulated.mean())] for series in test.series},
            "bands": {channel: {band: series.after for band, series in row.items()} for channel, row in test.bands.items()},
        }
        for test in result.tests
    }


def errors_in_waves(tests: Any) -> dict[str, Any]:
    """Errors of tests that `compare` simulated, as `errors_of` has them."""
    from calibration.residuals.sea_errors import in_bands

    errors = {}
    for test in tests:
        series = test.fit.series
        errors[test.fit.id] = {
            "use": test.fit.use,
            "relative": {motion.channel: motion.relative for motion in series},
            "mean": {x.channel: [float(x.measured.mean()), float(x.simulated.mean())] for x in series},
            "bands": {k: {b: band.error for b, band in row.items()} for k, row in in_bands(test).items() if k in DECAYS},
        }
    return errors


def declared() -> dict[str, Any]:
    """Errors of the baseline, nothing fitted: decays released as OpenFAST released them, and the sea."""
    import jax.numpy as jnp

    import jaxhydro as jh
    from calibration.campaign.load_campaign import load_campaign
    from calibration.residuals.measured_seas import compare
    from calibration.residuals.wave_options import options_of

    campaign = load_campaign(CAMPAIGN)
    model, errors = campaign.model, {}
    for dof in DECAYS:
        record = campaign.record(dof)
        start = np.array(json.loads((FOLDER / f"decay_{dof}_nwt" / "setup.json").read_text())["q0"], float)
        start[3:] = np.radians(start[3:])
        motion = jh.simulate(model, record.time, position=jnp.asarray(start), step=0.25)
        missed = {name: np.asarray(motion[name]) - record.values[name] for name in DECAYS}
        relative = {name: float(np.sqrt((x**2).mean()) / np.std(record.values[name])) for name, x in missed.items()}
        errors[dof] = {"use": record.use, "relative": relative, "bands": {}}
    comparison = compare(campaign, model, options_of(campaign))
    errors |= errors_in_waves(comparison.tests)
    return {"errors": errors, "notes": list(comparison.notes)}


def calibrated() -> dict[str, Any]:
    """The baseline calibrated to the three decays as `calibrate` does, and what it then makes of the sea."""
    from calibration import calibrate
    from calibration.campaign.load_campaign import load_campaign
    from calibration.residuals.measured_seas import compare
    from calibration.residuals.wave_options import options_of

    campaign = load_campaign(CAMPAIGN)
    result = calibrate(campaign)
    errors = {name: error for name, error in errors_of(result).items() if name in DECAYS}
    errors |= errors_in_waves(compare(campaign, result.model, options_of(campaign)).tests)
    return {"errors": errors, "parameters": values_of(result.parameters), "converged": result.converged}


def values_of(parameters: Any) -> dict[str, Any]:
    """Parameters as JSON."""
    return {k: [p.value, p.standard_deviation if p.identifiable else None, p.unit] for k, p in parameters.items()}


def diagnosed(part: str) -> dict[str, Any]:
    """Diagnosis of the campaign, which goes on where it was stopped.

    Args:
        part: `all`; `decays`, of which blocks are left out in turn; or `tables`, all with tables among the candidates.
    """
    from calibration.campaign.load_campaign import load_campaign
    from calibration.discovery.diagnose import diagnose
    from calibration.results.refusal_sentences import describe_refusal

    campaign = load_campaign(WITH_TABLES if part == "tables" else CAMPAIGN)
    if part == "decays":
        campaign = replace(campaign, records=tuple(record for record in campaign.records if record.id in DECAYS))

    def show(now: Any) -> None:
        if now.fraction != shown[0]:
            shown[0] = now.fraction
            print(f"  {part}: {now.stage}", flush=True)

    shown = [-1.0]
    checkpoint = CAMPAIGN / f".{part}-under-way"
    result = diagnose(campaign.model, campaign, progress=show, checkpoint=checkpoint)
    checkpoint.unlink(missing_ok=True)
    motions = {}
    for before, after in zip(result.baseline.tests, result.augmented.tests):
        motions[after.id] = {"time": after.time[::SHOWN].tolist()} | {
            final.channel: [x[::SHOWN].tolist() for x in (final.measured, baseline.simulated, final.simulated)]
            for baseline, final in zip(before.series, after.series)
        }
    return {
        "verdict": result.verdict,
        "effects": [
            {
                "effect": effect.effect,
                "motion": effect.degree_of_freedom,
                "parameters": values_of(effect.parameters),
                "score": effect.evidence.score,
                "bic": effect.evidence.delta_bic,
                "held": effect.evidence.holdout_gain,
                "clear": effect.evidence.clear,
                "share": effect.share,
                "alike": list(effect.indistinguishable),
                "in_doubt": effect.in_doubt,
            }
            for effect in result.effects
        ],
        "rejected": [
            [rejected.effect, rejected.degree_of_freedom, describe_refusal(rejected.reason)] for rejected in result.rejected
        ],
        "scores": [
            [s.round, s.effect, s.degree_of_freedom, s.gain, s.holdout, s.refitted, s.refitted_holdout] for s in result.scores
        ],
        "before": {"errors": errors_of(result.baseline), "parameters": values_of(result.baseline.parameters)},
        "after": {"errors": errors_of(result.augmented), "parameters": values_of(result.augmented.parameters)},
        "objective": {use: [fit.objective(use) for fit in (result.baseline, result.augmented)] for use in ("fit", "holdout")},
        "anatomy": [[x.test, x.channel, x.rms, x.noise, x.relative, x.words] for x in result.anatomy_before],
        "latent": [[force.motion, force.words] for force in result.latent],
        "unexplained": [result.unexplained_share, result.signature],
        "converged": [result.baseline.converged, result.augmented.converged],
        "notes": list(result.notes),
        "next": result.next_test,
        "seconds": result.seconds,
        "motions": motions,
    }
