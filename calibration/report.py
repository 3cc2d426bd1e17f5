"""One self-contained HTML page of what is in a result folder."""

import base64
from collections.abc import Iterable, Sequence
from html import escape
from os import PathLike
from pathlib import Path
from string import Template

from calibration.folder import DIAGNOSIS, FIGURES, GENERATOR, REPORT, RESULT, UNCERTAINTY
from calibration.formatting import number, percent, with_deviation
from calibration.manifest import IN_WAVES
from calibration.saved import Drawn, Error, Parameter, Saved, read_as, read_saved
from calibration.tables import USE
from jaxhydro.files import write_whole
from jaxhydro.problems import InputError, Problem

SWEEP, RESULTS = "sweep.json", "results.zarr"
_PNG = b"\x89PNG\r\n\x1a\n"
UNCONVERGED = '<p class="warning">The fit did not converge: what follows is where it stopped, not {}.</p>'


def write_report(folder: str | PathLike[str]) -> Path:
    """Write report.html into a result folder and give its path. Raises InputError where there are no results in it."""
    folder = Path(folder)
    try:
        there = [name for name in (DIAGNOSIS, RESULT, UNCERTAINTY, SWEEP) if folder.is_dir() and (folder / name).is_file()]
    except (OSError, ValueError):
        there = []
    if not there and (folder / RESULTS).is_dir():
        found = "one that was stopped: the same `jaxhydro sweep` goes on"
        raise InputError(str(folder), [Problem("", "a sweep that is done", found)])
    if not there:
        found = "a file" if folder.is_file() else "no such folder"
        found = f"no {RESULT}, {DIAGNOSIS}, {UNCERTAINTY} or {SWEEP}" if folder.is_dir() else found
        expected = "a folder that `jaxhydro calibrate`, `diagnose`, `uncertainty` or `sweep` wrote"
        raise InputError(str(folder), [Problem("", expected, found)])
    if there[0] == DIAGNOSIS:
        from calibration.discovery.page import page as diagnosis_page
        from calibration.discovery.saved import read_diagnosis

        text = diagnosis_page(read_diagnosis(folder / DIAGNOSIS), folder)
    elif there[0] == UNCERTAINTY:
        from calibration.uncertainty_page import page as uncertainty_page
        from calibration.uncertainty_saved import SavedUncertainty

        text = uncertainty_page(read_as(SavedUncertainty, folder / UNCERTAINTY), folder)
    elif there[0] == SWEEP:
        from calibration.sweep_page import SavedSweep
        from calibration.sweep_page import page as sweep_page

        text = sweep_page(read_as(SavedSweep, folder / SWEEP), folder)
    else:
        text = page(read_saved(folder / RESULT), folder)
    write_whole(folder / REPORT, text)
    return folder / REPORT


def page(saved: Saved, folder: Path) -> str:
    """The page's text. Whatever comes from files is escaped; images are part of the page."""
    fitted = saved.baseline
    errors = saved.errors(str(folder / RESULT))
    drawn = figures(images(saved.figures, folder).values())
    body = (
        _state(saved), "<h2>Tests</h2>", _tests(saved, errors), _bands(saved, str(folder / RESULT)),
        "<h2>Parameters</h2>", _parameters(fitted.parameters),
        f"<h2>Notes</h2>{listed(fitted.notes)}" if fitted.notes else "", f"<h2>Figures</h2>{drawn}" if drawn else "",
    )  # fmt: skip
    return framed(saved.campaign, f"Calibration by jaxhydro {saved.jaxhydro}", body, saved.jaxhydro)


def framed(title: str, by: str, body: Iterable[str], version: str) -> str:
    """A whole page around its parts, which are HTML."""
    return _PAGE.substitute(
        generator=f'{GENERATOR} {escape(version)}">', title=escape(title), by=escape(by), body="\n".join(filter(None, body)),
    )  # fmt: skip


def _state(saved: Saved) -> str:
    fitted, objective = saved.baseline, saved.baseline.objective
    wavy = any(test.use == "fit" and test.kind in IN_WAVES for test in saved.tests.values())
    meaning = "J, the sum of RMSE over standard deviation" if wavy else "Objective J, the sum of RMSE over standard deviation"
    lines = [f"{meaning}: <b>{number(objective.fit, 3)}</b> over the fitted tests"]
    if objective.holdout is not None:
        lines[0] += f", <b>{number(objective.holdout, 3)}</b> over those held out"
    if fitted.iterations is not None and fitted.seconds is not None:
        lines.append(f"{fitted.iterations} iterations in {fitted.seconds:.0f} s")
    if wavy:
        lines.append("tests in waves are fitted by the objective that was asked for, by default energy in bands")
    warning = "" if fitted.converged else UNCONVERGED.format("a calibration")
    return f"{warning}<p>{'; '.join(lines)}.</p>"


def _tests(saved: Saved, errors: dict[str, dict[str, Error]]) -> str:
    rows = []
    for id, channels in errors.items():
        about, use = saved.tests.get(id), str(saved.baseline.error[id].get("use", ""))
        kind = " in ".join(filter(None, (about.kind, about.degree_of_freedom))) if about else ""
        length = f"{number(about.duration, 3)} s" if about and about.duration is not None else ""
        named = sorted(channels.items(), key=lambda item: not item[1].in_objective)
        for i, (name, error) in enumerate(named or [("", None)]):
            first = [id, kind, length, USE.get(use, use)] if i == 0 else [""] * 4
            row = [*first, name, *_error(error)]
            muted = ' class="muted"' if error is not None and not error.in_objective else ""
            rows.append(f"<tr{muted}>{cells(row, 5)}</tr>")
    heads = ["Test", "Kind", "Length", "Use", "Channel", "RMSE", "of its motion", "before"]
    return table(heads, rows, 5)


def _bands(saved: Saved, source: str) -> str:
    """Errors of energy in bands, where there are any."""
    rows = []
    for id, channels in saved.bands(source).items():
        use = USE.get(str(saved.baseline.error[id].get("use", "")), "")
        for channel, bands in channels.items():
            for band, (before, after) in bands.items():
                shown = ["–" if one is None else f"{100 * one:+.0f} %" for one in (before, after)]
                rows.append(f"<tr>{cells([id, use, channel, band.replace('_', ' '), *shown], 4)}</tr>")
    heads = ["Test", "Use", "Channel", "Band", "Before", "After"]
    return f"<h2>Errors of energy in bands</h2>{table(heads, rows, 4)}" if rows else ""


def _error(error: Error | None) -> list[str]:
    if error is None:
        return ["not finite", "", ""]
    before = percent(error.before.relative) if error.before is not None else "–"
    return [f"{number(error.rmse, 2)} {error.unit}", percent(error.relative), before]


def _parameters(parameters: dict[str, Parameter]) -> str:
    rows = []
    for label, one in parameters.items():
        value = with_deviation(one.value, one.standard_deviation) if one.identifiable else "not identifiable"
        flag = "at its bound" if one.at_bound else ""
        row = [label, one.meaning, number(one.start, 3), value, one.unit, flag]
        rows.append(f"<tr{'' if one.identifiable else ' class=muted'}>{cells(row, 2, 4)}</tr>")
    return table(["Parameter", "Meaning", "Start", "Calibrated ± 1 sd", "Unit", ""], rows, 2, 4)


def listed(texts: Iterable[str]) -> str:
    """A list of points."""
    return f"<ul>{''.join(f'<li>{escape(text)}</li>' for text in texts)}</ul>"


def images(stated: Iterable[Drawn], folder: Path) -> dict[str, str]:
    """Figures by name in their stated order, then others that are there; only PNG files of the folder itself are taken."""
    there = {path.name: path for path in sorted((folder / FIGURES).glob("*.png")) if path.is_file()}
    captions = {Path(figure.file).name: figure.caption for figure in stated}
    names = [name for name in captions if name in there] + [name for name in there if name not in captions]
    parts = {}
    for name in names:
        if part := embedded(there[name], captions.get(name) or name):
            parts[name] = part
    return parts


def embedded(path: Path, caption: str) -> str:
    """A PNG file as a figure of the page; nothing where it is none."""
    content = path.read_bytes()
    if not content.startswith(_PNG):
        return ""
    data, caption = base64.b64encode(content).decode("ascii"), escape(caption)
    return f'<figure><img alt="{caption}" src="data:image/png;base64,{data}"><figcaption>{caption}</figcaption></figure>'


def figures(parts: Iterable[str]) -> str:
    """Figures in two columns; nothing where there are none."""
    together = "".join(parts)
    return f"<div class=figures>{together}</div>" if together else ""


def table(heads: Sequence[str], rows: Iterable[str], first: int, last: int = 99) -> str:
    """A table of rows that are HTML; columns from `first` on, up to before `last`, are numbers."""
    head = "".join(f"<th{_right(i, first, last)}>{escape(name)}</th>" for i, name in enumerate(heads))
    return f"<div class=scroll><table><thead><tr>{head}</tr></thead><tbody>{''.join(rows)}</tbody></table></div>"


def cells(texts: Sequence[str], first: int, last: int = 99) -> str:
    """The cells of a row, for columns as in `table`."""
    return "".join(f"<td{_right(i, first, last)}>{escape(text)}</td>" for i, text in enumerate(texts))


def _right(i: int, first: int, last: int) -> str:
    return " class=number" if first <= i < last else ""


_PAGE = Template("""\
<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
$generator
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>$title</title>
<style>
body { font: 15px/1.5 system-ui, "Segoe UI", "DejaVu Sans", sans-serif; color: #22262c; background: #fff;
  max-width: 62rem; margin: 2rem auto; padding: 0 1.2rem; }
h1 { font-size: 1.5rem; margin: 0 0 .2rem; } h2 { font-size: 1.1rem; margin: 2rem 0 .5rem; }
.by, .muted td, figcaption { color: #6a717b; }
.by { margin: 0 0 1.2rem; }
.warning { background: #fbe9e7; border-left: 4px solid #d1495b; padding: .6rem .9rem; font-weight: 600; }
.verdict { background: #eef3f8; border-left: 4px solid #4f7cac; padding: .6rem .9rem; font-size: 1.1rem; }
.size { font-size: 1.05rem; margin: .2rem 0 .4rem; } h3 { font-size: 1rem; margin: 1.3rem 0 .2rem; }
.scroll { overflow-x: auto; }
table { border-collapse: collapse; font-size: .92rem; }
th, td { text-align: left; padding: .2rem .9rem .2rem 0; border-bottom: 1px solid #e4e6ea; vertical-align: top; }
th { border-bottom: 1px solid #9aa1ab; font-weight: 600; }
.number { text-align: right; white-space: nowrap; font-variant-numeric: tabular-nums; }
td:first-child { white-space: nowrap; }
.figures { columns: 2; column-gap: 2rem; }
figure { margin: 0 0 1.6rem; break-inside: avoid; } img { width: 100%; height: auto; }
figcaption { font-size: .85rem; line-height: 1.35; }
@media (max-width: 45rem) { .figures { columns: 1; } }
@media print { body { margin: 0; max-width: none; font-size: 10pt; } }
</style>
</head>
<body>
<h1>$title</h1>
<p class="by">$by</p>
$body
</body>
</html>
""")
