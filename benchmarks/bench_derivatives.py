"""Derivatives of a decay and of a sea, in simulations of the same."""

from collections.abc import Iterator

from benchmarks import bench_decay, bench_sea
from benchmarks.bench_cases import Decay
from benchmarks.bench_timing import Row


def measure(quick: bool) -> Iterator[tuple[list[Row], list[str]]]:
    """Jacobians and gradients of both."""
    yield bench_decay.derivatives(Decay(60.0 if quick else 600.0), 2 if quick else 7, quick)
    if not quick:
        yield bench_sea.derivatives(bench_sea.Hour(3600.0), 3)
