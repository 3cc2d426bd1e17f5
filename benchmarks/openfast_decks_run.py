"""Runs of exported decks in OpenFAST: edits of their keys, waves of given components, motions and messages."""

import re
import subprocess
from collections.abc import Mapping
from pathlib import Path
from typing import NamedTuple

import numpy as np
from jaxtyping import Float

import jaxhydro as jh
from jaxhydro.interop.data_files import read_table

Edits = Mapping[str, Mapping[str, object]]  # values by key, by file of the deck
TROUBLE = re.compile(r"(?i)warning|error|fatal|abort|severe")  # words of a message that is no progress report
HARMLESS = re.compile(r"(?i)error stop|error code 0")
CHANNELS = ("PtfmSurge", "PtfmSway", "PtfmHeave", "PtfmRoll", "PtfmPitch", "PtfmYaw")
TEXT_OUTPUT = {"OutFileFmt": 1, "OutFmt": '"ES18.9E3"'}  # of main.fst: the binary output has 16 bits
WAVE_STEP = 0.25  # s, WaveDT


class Run(NamedTuple):
    """A run of OpenFAST.

    Attributes:
        status: Exit status.
        messages: Lines of its log with a warning or an error.
        times: Output times (s), (t,).
        motion: Motion of the reference point (m, rad), (6, t).
        elevation: Wave elevation at the origin (m), (t,).
    """

    status: int
    messages: tuple[str, ...]
    times: Float[np.ndarray, " t"]
    motion: Float[np.ndarray, "6 t"]
    elevation: Float[np.ndarray, " t"]


def edit(deck: Path, edits: Edits) -> None:
    """Change values of keys of a deck's files in place.

    Args:
        deck: Folder of the deck.
        edits: New values by key, by file name.

    Raises:
        KeyError: A file has no such key.
    """
    for name, values in edits.items():
        content = (deck / name).read_text(encoding="utf-8")
        for key, value in values.items():
            content, count = re.subn(rf"(?m)^\s*\S+(\s+{re.escape(key)}(\s|$))", rf"{value}\1", content)
            if not count:
                raise KeyError(f"{name} has no {key}")
        (deck / name).write_text(content, encoding="utf-8")


def initial(position: Float[np.ndarray, "6"]) -> Edits:
    """Edits that release a platform from a position (m, rad)."""
    values = np.concatenate([position[:3], np.degrees(position[3:])])
    return {"elastodyn.dat": {key: repr(float(value)) for key, value in zip(CHANNELS, values, strict=True)}}


def add_waves(deck: Path, waves: jh.Components) -> None:
    """Give a deck waves of known components (WaveMod 7).

    Args:
        deck: Folder of the deck.
        waves: The components, harmonics of one period.
    """
    heading, phase = (np.degrees(np.asarray(values)) for values in (waves.heading, waves.phase))
    columns = np.stack([np.asarray(waves.omega), 2 * np.asarray(waves.amplitude), heading, phase], axis=1)
    rows = [" ".join(f"{value:.9g}" for value in row) for row in columns if row[1] > 0.0]
    text = "omega(rad/s) height(m) direction(deg) phase(deg)\n" + "\n".join(rows) + "\n"
    (deck / "waves.txt").write_text(text, encoding="utf-8")
    period = round(float(waves.period), 6)
    values = {"WaveMod": 7, "WvKinFile": '"waves.txt"', "WaveTMax": period, "WaveDT": WAVE_STEP}
    edit(deck, {"seastate.dat": values | {"WvLowCOff": 0.0, "WvHiCOff": 100.0}})


def run(executable: Path | str, deck: Path, timeout: float = 3600.0) -> Run:
    """Run a deck, and read its motion.

    Args:
        executable: OpenFAST.
        deck: Folder of the deck, with main.fst.
        timeout: Longest wall time, s.

    Returns:
        The run. Motions are empty where OpenFAST has stopped with an error.
    """
    done = subprocess.run([str(executable), "main.fst"], cwd=deck, capture_output=True, text=True, timeout=timeout, check=False)
    log = done.stdout + done.stderr
    (deck / "log.txt").write_text(log, encoding="utf-8")
    return outcome(deck, done.returncode)


def outcome(deck: Path, status: int) -> Run:
    """Result of a run that has ended, from its log.txt and its output.

    Args:
        deck: Folder of the deck.
        status: Exit status of OpenFAST.
    """
    lines = [line.strip() for line in (deck / "log.txt").read_text(encoding="utf-8").splitlines()]
    messages = tuple(line for line in lines if TROUBLE.search(line) and not HARMLESS.search(line))
    output = next((deck / name for name in ("main.out", "main.outb") if (deck / name).exists()), None)
    if status or output is None:
        return Run(status or 1, messages, np.zeros(0), np.zeros((6, 0)), np.zeros(0))
    table = read_table(output)
    motion = np.stack([table[name].to_numpy(float) for name in CHANNELS])
    motion[3:] = np.radians(motion[3:])
    elevation = table["Wave1Elev"].to_numpy(float) if "Wave1Elev" in table else np.zeros(len(table))
    return Run(0, messages, table["Time"].to_numpy(float), motion, elevation)
