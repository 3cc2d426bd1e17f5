"""Makes docs/validation.md and its figures: every number on the page comes from a run of this program.

    python -m benchmarks.validate [--seeds 20] [--starts 20] [--diagnoses 244] [--processes 2]
                                  [--only SECTION ...] [--fresh] [--stale] [--text]

Finished parts are kept in .venv/validate-cache under a hash of the sources and files that they depend on; what has not
changed is not done again, and a run that was stopped goes on where it was. Of a section's own modules the hash covers those
that run (`_runs`), not those that make its text (`_text`). `--fresh` forgets them first. `--stale`
takes what earlier sources gave rather than running anything long, and says so on the page; what was said of the campaigns of
`diagnoses`, too many for one day, is kept in docs/diagnoses.jsonl for it.

Results are JSON in docs/evidence, apart from the text that is made of them. `--text` makes the page again of these and runs
nothing: a section that has no results there stays as it is until its next run, and is named.
"""

import argparse
import re
import shutil
import sys
import textwrap
import time
from pathlib import Path
from types import ModuleType

from benchmarks.evidence import (
    classical_bias,
    common,
    coverage,
    diagnoses,
    focal_laboratory,
    focal_tables,
    global_search,
    hulls,
    identified,
    lacking,
    measured,
    measured_waves,
    mooring_lines,
    numerical_tank,
    openfast,
    openfast_waves,
    periods,
    seeds,
    starts,
    study,
    tuned_seas,
)
from benchmarks.evidence.common import CACHE, ROOT, Absent, Section, say

PAGE = ROOT / "docs" / "validation.md"
MODULES: dict[str, ModuleType] = {  # by section, in the page's order
    "seeds": seeds,
    "coverage": coverage,
    "identified": identified,
    "periods": periods,
    "hulls": hulls,
    "mooring_lines": mooring_lines,
    "openfast": openfast,
    "openfast_waves": openfast_waves,
    "measured": measured,
    "measured_waves": measured_waves,
    "focal_laboratory": focal_laboratory,
    "focal_tables": focal_tables,
    "tuned_seas": tuned_seas,
    "classical_bias": classical_bias,
    "starts": starts,
    "global_search": global_search,
    "study": study,
    "diagnoses": diagnoses,
    "lacking": lacking,
    "numerical_tank": numerical_tank,
}
SECTIONS = tuple(MODULES)
IN_PARALLEL = (
    "coverage",
    "identified",
    "measured_waves",
    "tuned_seas",
    "classical_bias",
    "global_search",
    "lacking",
    "numerical_tank",
)
INTRO = """\
# Validation

Made by `make validate` (`python -m benchmarks.validate`); do not edit. Every number is from a run.

- J is the sum over the records of the root-mean-square error (RMSE) divided by the record's standard deviation.
- *z* is an error divided by its own stated standard deviation.

"""
SUMMARY = Path(__file__).parent / "evidence" / "summary.md"  # chosen by hand from the sections


def section(name: str, options: argparse.Namespace, figures: Path) -> Section:
    """One section, worked out."""
    if name == "seeds":
        return seeds.run(options.seeds, options.processes, figures)
    if name == "starts":
        return starts.run(options.starts, options.processes, figures)
    if name == "diagnoses":
        return diagnoses.run(figures, options.processes, options.diagnoses)
    if name in IN_PARALLEL:
        return MODULES[name].run(figures, options.processes)
    return MODULES[name].run(figures)


def command(name: str, options: argparse.Namespace) -> str:
    """What makes a section alone."""
    counts = {
        "seeds": f" --seeds {options.seeds}",
        "starts": f" --starts {options.starts}",
        "diagnoses": f" --diagnoses {options.diagnoses}",
    }
    return f"python -m benchmarks.validate --only {name}{counts.get(name, '')}"


def written(name: str, result: Section, options: argparse.Namespace) -> str:
    """A section as it stands on the page, its figures copied beside it."""
    lines = [f"## {result.title}", "", f"`{command(name, options)}`", ""]
    if name in common.stale:
        lines += ["*From runs of earlier sources, wholly or in part.*", ""]
    lines += [wrapped(result.text.strip()), ""]
    folder = PAGE.parent / "figures"
    folder.mkdir(parents=True, exist_ok=True)
    for path in result.figures:
        if path.exists() or not common.text_only:  # a figure of a run stays as it is on the page
            shutil.copyfile(path, folder / path.name)
        lines += [f"![{path.stem.replace('-', ' ')}](figures/{path.name})", ""]
    lines += [f"Falls short: {words}.\n" for words in result.short]
    return "\n".join(lines)


def wrapped(text: str) -> str:
    """Paragraphs and items in lines of 120; tables, headings and figures as they are."""
    keep = ("|", "#", "!")
    parts: list[str] = []
    for line in text.splitlines():
        goes_on = parts and parts[-1] and not parts[-1].startswith(keep) and line and not line.startswith((*keep, "- "))
        parts[-1:] = [f"{parts[-1]} {line}"] if goes_on else [*parts[-1:], line]
    lines = [
        part
        if part.startswith(keep)
        else textwrap.fill(
            part, 120, subsequent_indent="  " if part.startswith("- ") else "", break_long_words=False, break_on_hyphens=False
        )
        for part in parts
    ]
    return "\n".join(lines)


def former() -> dict[str, str]:
    """The sections of the page as it is."""
    text = PAGE.read_text() if PAGE.exists() else ""
    parts = re.findall(r"<!-- (\w+) -->\n(.*?)(?=<!-- \w+ -->\n|\Z)", text, re.DOTALL)
    return {name: body.strip() + "\n" for name, body in parts if name in SECTIONS}


def write_page(parts: dict[str, str]) -> None:
    """The page: what falls short first, then the sections in order."""
    short = re.findall(r"^Falls short: (.*)\.$", "\n".join(parts.values()), re.MULTILINE)
    points = "".join(f"- {words}\n" for words in short or ["nothing that has a goal here"])
    head = f"{INTRO}{SUMMARY.read_text()}\nWhat falls short:\n\n{points}"
    body = "".join(f"\n<!-- {name} -->\n{parts[name].strip()}\n" for name in SECTIONS if name in parts)
    PAGE.parent.mkdir(parents=True, exist_ok=True)
    PAGE.write_text(head + body)


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--seeds", type=int, default=20, help="seeds of noise (default 20)")
    parser.add_argument("--starts", type=int, default=20, help="far starts (default 20)")
    campaigns = len(list(diagnoses.cases()))
    parser.add_argument("--diagnoses", type=int, default=campaigns, help="campaigns to diagnose at most (default: all)")
    parser.add_argument("--processes", type=int, default=2, help="at work at once (default 2)")
    parser.add_argument("--only", nargs="+", choices=SECTIONS, default=SECTIONS, help="sections to make; others stay")
    parser.add_argument("--fresh", action="store_true", help="forget finished parts first")
    parser.add_argument("--stale", action="store_true", help="take finished parts of earlier sources")
    parser.add_argument("--text", action="store_true", help="make the page again of the results that there are; nothing is run")
    options = parser.parse_args()
    common.accept_stale, common.text_only = options.stale, options.text
    parts = former()
    for number, name in enumerate(options.only, 1):
        say(f"[{number}/{len(options.only)}] {name}")
        if options.fresh:
            shutil.rmtree(CACHE / name, ignore_errors=True)
        begun = time.monotonic()
        try:
            result = section(name, options, CACHE / name / "figures")
        except Absent as reason:
            say(f"  skipped: {reason}; {'the page keeps what it had' if name in parts else 'the page is without it'}")
            continue
        parts[name] = written(name, result, options)
        write_page(parts)  # after each, so that a run that is stopped leaves a page
        say(f"  {time.monotonic() - begun:.0f} s")
    say(f"{PAGE.relative_to(ROOT)} is written")


if __name__ == "__main__":
    try:
        main()
    except KeyboardInterrupt:
        sys.exit("stopped; finished parts are kept, start again to go on")
