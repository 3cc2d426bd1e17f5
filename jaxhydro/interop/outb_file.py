"""Writing of OpenFAST's binary outputs (.outb).

Channels are 16-bit integers, each with its own scale and offset.

References:
    OpenFAST v5.0.0 (2895884), NWTC_IO.f90: WrBinFAST, with FileFmtID_ChanLen_In.
    ReadFASTbinary.m of OpenFAST's matlab-toolbox: value = (integer - offset) / scale.
"""

import struct
from collections.abc import Sequence
from pathlib import Path

import numpy as np

CHANNEL_LENGTH_FORMAT = 4  # FileFmtID_ChanLen_In
NAME_WIDTH = 10  # characters of a channel's name, and of its unit with its brackets
LOWEST, HIGHEST = -32768, 32767  # of a 16-bit integer
MAX_OFFSET = 2**22  # steps: beyond it a float32 does not tell half steps


def write_outb(
    path: Path, start: float, interval: float, names: Sequence[str], units: Sequence[str], values: np.ndarray, about: str
) -> None:
    """Write a binary output of OpenFAST, with times at even intervals.

    A channel is resolved to 1/65535 of its range, or to float32's resolution of its largest value where that is coarser.

    Args:
        path: The file.
        start: Time of the first sample (s).
        interval: Time between samples (s).
        names: Names of the channels without Time, at most 10 ASCII characters each.
        units: Their units, at most 8 ASCII characters each.
        values: Finite samples, (t, channel).
        about: Description of the run, in ASCII: other characters become question marks.

    Raises:
        ValueError: A name or a unit is too long, or does not belong to a channel.
    """
    words = ["Time", *names, "(s)", *(f"({unit})" for unit in units)]
    if not len(names) == len(units) == values.shape[1]:
        raise ValueError(f"a name and a unit for each of {values.shape[1]} channels, found {len(names)} and {len(units)}")
    if long := [word for word in words if len(word) > NAME_WIDTH or not word.isascii()]:
        raise ValueError(f"at most {NAME_WIDTH} ASCII characters, found {long[0]!r}")
    lowest, span = values.min(axis=0), np.ptp(values, axis=0)
    sizes = np.abs(values).max(axis=0)
    steps = np.divide(HIGHEST - LOWEST, span, out=np.full(len(span), np.inf), where=span > 0)
    finest = np.divide(MAX_OFFSET, sizes, out=np.ones(len(span)), where=sizes > 0)
    scale = np.minimum(steps, finest).astype("<f4")
    offset = (LOWEST - lowest * scale.astype(float)).astype("<f4")
    packed = np.clip(np.round(values * scale.astype(float) + offset.astype(float)), LOWEST, HIGHEST).astype("<i2")
    text = about.encode("ascii", "replace")
    with path.open("wb") as file:
        file.write(struct.pack("<hhii2d", CHANNEL_LENGTH_FORMAT, NAME_WIDTH, len(names), len(values), start, interval))
        file.write(scale.tobytes() + offset.tobytes())
        file.write(struct.pack("<i", len(text)) + text)
        file.write(b"".join(word.ljust(NAME_WIDTH).encode() for word in words))
        file.write(packed.tobytes())
