"""Printed output of the command line: tables, messages and progress.

Text that comes from files is never read as markup.
"""

import math
import os
import sys
import time as clock
import warnings
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from typing import Any

from rich import box
from rich.cells import cell_len
from rich.console import Console
from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn, TimeRemainingColumn
from rich.table import Table
from rich.text import Text

from jaxhydro.errors import PrintedWarning
from jaxhydro.interrupts import stop_if_asked

PROGRESS_INTERVAL = 10.0  # s between lines of progress that go to a file
MIN_ESTIMATED = 0.15  # fraction done from which the time left is told: before, it is mostly compilation
WIDTH = 120  # where there is no terminal to ask
WIDE_GAP, NARROW_GAP = 3, 2  # characters between the columns of a table


def console(stderr: bool = False) -> Console:
    """The console of standard output or standard error, as wide as the terminal, or as COLUMNS says."""
    terminal = (sys.stderr if stderr else sys.stdout).isatty() or os.environ.get("COLUMNS", "").isdigit()
    return Console(stderr=stderr, width=None if terminal else WIDTH, highlight=False)


def say(message: str, style: str = "", stderr: bool = False) -> None:
    """Print text as it is, unwrapped where it goes to a file."""
    console(stderr).print(Text(message, style=style), soft_wrap=True)


def complain(message: str) -> None:
    """Print what is wrong, on standard error."""
    console(stderr=True).print(Text.assemble(("jaxhydro: ", "bold red"), message), soft_wrap=True)


@contextmanager
def warnings_told() -> Iterator[None]:
    """Context in which this package's warnings are printed as its messages are, each once."""
    shown, told = warnings.showwarning, set[str]()

    def show(message: Any, category: type[Warning], *where: Any) -> None:
        if not issubclass(category, PrintedWarning):
            shown(message, category, *where)
        elif str(message) not in told:
            told.add(str(message))
            complain(f"warning: {message}")

    warnings.showwarning = show  # type: ignore[assignment]
    try:
        yield
    finally:
        warnings.showwarning = shown


def table(title: str, heads: Iterable[str], rows: Iterable[Iterable[str]], left: int = 1, stderr: bool = False) -> None:
    """Print a table whose first `left` columns are text, and the others numbers.

    Long cells are wrapped between words. Words stay whole, since names and labels are typed again. A table of many columns
    may be wider than the terminal for that.
    """
    shown = console(stderr)
    lines = [list(heads), *(list(row) for row in rows)]
    columns = list(zip(*lines, strict=True))
    gap = WIDE_GAP
    if sum(map(_longest, columns)) > shown.width - _between(columns, gap):
        gap = NARROW_GAP
    widths = column_widths(columns, shown.width - _between(columns, gap))
    shown.width = max(shown.width, sum(widths) + _between(columns, gap))  # rich would cut what is beyond
    # one space of every gap is the box's own
    drawn = Table(box=box.SIMPLE_HEAD, pad_edge=False, padding=(0, 1, 0, gap - 2))
    for i, (head, width) in enumerate(zip(lines[0], widths)):
        drawn.add_column(Text(head), justify="left" if i < left else "right", overflow="fold", width=width)
    for row in lines[1:]:
        drawn.add_row(*(Text(cell) for cell in row))
    say(f"\n{title}", "bold", stderr)
    shown.print(drawn)


def column_widths(columns: Sequence[Sequence[str]], room: int) -> list[int]:
    """Widths of columns that together take `room` characters, or more where words would break.

    The widest columns are narrowed first. A word breaks only if it is longer than half the room.
    """
    widths = [_longest(column) for column in columns]
    least = [min(_longest(word for cell in column for word in cell.split()), max(room // 2, 1)) for column in columns]
    while sum(widths) > room:
        widest = max((i for i in range(len(widths)) if widths[i] > least[i]), key=lambda i: (widths[i], i), default=None)
        if widest is None:
            break
        widths[widest] -= 1
    return widths


def _longest(texts: Iterable[str]) -> int:
    return max(map(cell_len, texts), default=1)


def _between(columns: Sequence[Sequence[str]], gap: int) -> int:
    """Characters of a table's line that are not of its cells: gaps, and a space at either end."""
    return gap * (len(columns) - 1) + 2


@contextmanager
def progress() -> Iterator[Callable[[Any], None]]:
    """Line on standard error with the progress of a calibration.

    It has the stage, iteration, objective, time gone and time left. Without a terminal it is one line per stage.

    Yields:
        A function to call with the progress.
    """
    shown, begun, furthest = console(stderr=True), clock.monotonic(), 0.0

    def left(fraction: float) -> str:
        """Time left, from the time gone and the fraction done."""
        gone = clock.monotonic() - begun
        if gone < PROGRESS_INTERVAL or not MIN_ESTIMATED <= fraction < 1:
            return ""
        return f"about {_span(gone * (1 - fraction) / fraction)} left"

    if not shown.is_terminal:
        stages: list[str] = []
        shown.print(Text("preparing; a first run compiles its programs, which takes longer"), soft_wrap=True)

        def note(now: Any) -> None:
            nonlocal furthest
            stop_if_asked()
            furthest = max(furthest, now.fraction)
            if now.stage not in stages:
                stages.append(now.stage)
                status = ": ".join(filter(None, (now.stage, _reached(now))))
                shown.print(Text("; ".join(filter(None, (status, left(furthest))))), soft_wrap=True)

        yield note
        return
    columns = (
        TextColumn("{task.description}"),
        BarColumn(bar_width=24),
        TextColumn("{task.fields[state]}"),
        TimeElapsedColumn(),
        TextColumn("{task.fields[left]}"),
    )
    with Progress(*columns, console=shown, transient=True) as bar:
        task = bar.add_task("preparing", total=1.0, state="", left="")

        def update(now: Any) -> None:
            nonlocal furthest
            stop_if_asked()
            furthest = max(furthest, now.fraction)
            bar.update(task, description=str(now.stage), completed=furthest, state=_reached(now), left=left(furthest))

        yield update


@contextmanager
def counting(total: int, done: int, noun: str) -> Iterator[Callable[[int, str], None]]:
    """Line on standard error with the number of jobs done, a remark, and the time left.

    Without a terminal it is a line every `PROGRESS_INTERVAL` seconds, and one at the end.

    Args:
        total: Number of jobs.
        done: Number of jobs that are done at the beginning.
        noun: Plural of what is counted, such as `runs`.

    Yields:
        A function to call with the number of jobs done and a remark, such as their speed.
    """
    shown = console(stderr=True)
    if not shown.is_terminal:
        told: list[tuple[float, int]] = []  # when how many were done

        def note(now: int, remark: str) -> None:
            time = clock.monotonic()
            if told and now < total and time - told[-1][0] < PROGRESS_INTERVAL:
                return
            time_left = ""
            if told and now > told[0][1]:  # the first one takes compilation along
                time_left = f", {_span((time - told[0][0]) * (total - now) / (now - told[0][1]))} left"
            told.append((time, now))
            shown.print(Text(f"{now} of {total} {noun}, {remark}{time_left}"), soft_wrap=True)

        yield note
        return
    columns = (
        TextColumn("{task.completed:.0f} of {task.total:.0f} {task.description}"),
        BarColumn(bar_width=24),
        TextColumn("{task.fields[remark]}"),
        TimeElapsedColumn(),
        TextColumn("left"),
        TimeRemainingColumn(),
    )
    with Progress(*columns, console=shown, transient=True) as bar:
        task = bar.add_task(noun, total=total, completed=done, remark="compiling")
        yield lambda now, remark: bar.update(task, completed=now, remark=remark)


def _span(seconds: float) -> str:
    """A time in words."""
    for size, name in ((86400, "d"), (3600, "h"), (60, "min")):
        if seconds >= size:
            return f"{seconds / size:.1f} {name}"
    return f"{seconds:.0f} s"


def _reached(now: Any) -> str:
    """Iteration and objective; nothing in a stage that has none."""
    return f"iteration {now.iteration}, {now.name} = {now.objective:.4g}" if math.isfinite(now.objective) else ""
