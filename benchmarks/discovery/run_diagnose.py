"""Answers of `jaxhydro diagnose`: the command on every campaign, and its results in the benchmark's JSON."""

import subprocess
import sys
from collections.abc import Iterable, Iterator
from concurrent.futures import ThreadPoolExecutor, as_completed
from pathlib import Path
from typing import Any

from benchmarks.discovery.answer_file import Answer, AnswerFile, ClaimedEffect, HeldOutErrors, read_json
from calibration.results.result_folder import DIAGNOSIS_FILE
from jaxhydro import __version__
from jaxhydro.result_model import write_json


def diagnose_all(folder: Path, names: Iterable[str], out: Path, processes: int) -> Iterator[tuple[str, Answer | str]]:
    """Run `jaxhydro diagnose` on campaigns; complete results of earlier runs are taken.

    Args:
        folder: The benchmark's folder.
        names: Names of the campaigns.
        out: Folder of the results, one folder per campaign.
        processes: Campaigns at a time.

    Yields:
        Name and answer of each campaign as it is done, or the last line of the command's messages where there is none.
    """
    pool = ThreadPoolExecutor(processes)
    try:
        jobs = {pool.submit(diagnose_one, folder / name, out / name): name for name in names}
        for job in as_completed(jobs):
            yield jobs[job], job.result()
    finally:
        pool.shutdown(cancel_futures=True)


def diagnose_one(campaign: Path, out: Path) -> Answer | str:
    """Answer to a campaign. See `diagnose_all`."""
    if (answer := answer_in(out)) is not None:
        return answer
    command = [sys.executable, "-m", "jaxhydro", "diagnose", str(campaign), "--out", str(out), "--no-figures"]
    done = subprocess.run(command, capture_output=True, text=True)
    return answer_in(out) or f"exit status {done.returncode}: {(done.stderr.strip() or 'no message').splitlines()[-1]}"


def answer_in(out: Path) -> Answer | None:
    """Answer in a results folder; None where there is no complete result."""
    if not (out / DIAGNOSIS_FILE).exists():
        return None
    saved = read_json(out / DIAGNOSIS_FILE, "a diagnosis")
    return answer_of(saved) if saved.get("complete", True) else None


def answer_of(saved: dict[str, Any]) -> Answer:
    """Answer of a diagnosis.json. Probabilities are those that the file states."""
    missing, errors = saved["missing"], [saved[name]["objective"].get("holdout") for name in ("baseline", "augmented")]
    before, after = errors
    seconds = saved.get("seconds")
    return Answer(
        verdict=missing["verdict"],
        effects=[_claim(effect) for effect in missing["effects"]],
        considered=[_claim(effect) for effect in missing["rejected"] if effect.get("probability") is not None],
        held_out_error=None if before is None or after is None else HeldOutErrors(baseline=before, final=after),
        minutes=None if seconds is None else seconds / 60,
    )


def _claim(effect: dict[str, Any]) -> ClaimedEffect:
    return ClaimedEffect(
        effect=effect["effect"],
        motion=effect.get("degree_of_freedom"),
        probability=effect.get("evidence", effect).get("probability"),
        indistinguishable_from=[text.split(" ")[0] for text in effect.get("indistinguishable_from", [])],
    )


def write_answers(path: Path, answers: dict[str, Answer], method: str = f"jaxhydro diagnose {__version__}") -> None:
    """Write a file of answers."""
    path.parent.mkdir(parents=True, exist_ok=True)
    file = AnswerFile(method=method, campaigns=dict(sorted(answers.items())))
    write_json(file.model_dump(mode="json", exclude_defaults=True), path)
