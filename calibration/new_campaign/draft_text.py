"""Text of a drafted campaign.yaml: every key with a comment, every guess marked CHECK."""

from __future__ import annotations

import json
import re
from collections.abc import Iterable, Iterator

from calibration.campaign.manifest_sections import IN_WAVES, WAVE
from calibration.new_campaign.campaign_draft import CampaignDraft, TestDraft
from calibration.new_campaign.column_guesses import MAX_RADIAN_RANGE, ColumnGuess

MAX_COMMENT_COLUMN = 88  # comments of a block are aligned up to here

_HEAD = """\
# Campaign made by `jaxhydro init`. {mark}
# Then: jaxhydro check FOLDER, and jaxhydro calibrate FOLDER --out fit. All keys are described in docs/formats.md.
# Sizes and times are as the files have them, also where `scale` is not 1.
"""
_MARKS = {
    True: "What is marked CHECK was guessed from the data files: check it.",
    False: "What is marked CHECK is an example: put your own in.",
}
_OPTIONAL = """\
# noise: {surge: 0.01}          # standard deviation of the sensor's noise, in the unit of the channel; left out: estimated
# tracked_point: [0, 0, 0.5]    # where motions were recorded, m from the reference point; left out: at the reference point
"""
_NO_ZERO = (
    "# zero: {window: [0.0, 10.0]}   # times of still water in every file, or {test: ID}; left out: the files' zero is kept\n"
)
_TESTS = """\
# kind: decay, regular, irregular, static, forced. use: fit; holdout, which judges the fit; ignore.
# More keys of a test: window: [t0, t1], the part of the file; transient: 100, left out at the start of a test in waves.
"""
_EXAMPLE_IN_WAVES = """\
#  - {id: sea-1, kind: irregular, file: sea-1.csv, use: fit}     # a test in waves needs `wave_channel`
#  - {id: wave-1, kind: regular, file: wave-1.csv, use: fit}
"""
_EXAMPLE_SIZES = {"column.Cd_t": 1.0}


def campaign_text(draft: CampaignDraft) -> str:
    """Write a draft as the text of a campaign.yaml."""
    scale = "70 for files of a model at 1:70; 1 for files at the scale of platform.yaml"
    copied = f"a copy of {draft.platform}" + ("" if draft.own_platform else "; put your platform's sizes in")
    head = [
        (f"name: {yaml_scalar(draft.name)}", ""),
        ("platform: platform.yaml", f"CHECK: {copied}"),
        (f"scale: {draft.scale or 1.0:g}", f"CHECK: Froude length scale: {scale}"),
    ]
    blocks = [
        _HEAD.format(mark=_MARKS[draft.from_files]),
        _aligned(head),
        "channels:  # column: a header, or a number from 0; ",
    ]
    blocks[-1] += "unit; `sign: -1` where the axis is reversed\n"
    blocks.append(
        _aligned((_channel(name, guess), _reason(guess, draft)) for name, guess in draft.columns.items() if name != WAVE)
    )
    out = {name: guess for test in draft.tests for name, guess in test.left_out.items() if name not in draft.columns}
    blocks.append("".join(f"# {_channel(name, guess)}   # left out: beyond 90 deg\n" for name, guess in out.items()))
    blocks += [_wave_channel(draft), _zero(draft), _OPTIONAL, "tests:\n", _TESTS, _aligned(map(_test_line, draft.tests))]
    if not draft.from_files:
        blocks.append(_EXAMPLE_IN_WAVES)
    return "".join((*blocks, _calibrate(draft)))


def yaml_scalar(value: str | int) -> str:
    """A name or number as YAML; text that could be read otherwise is quoted."""
    if isinstance(value, int):
        return str(value)
    plain = re.fullmatch(r"[A-Za-z][\w.-]*", value) and value.isascii()
    words = {"true", "false", "null", "yes", "no", "on", "off", "y", "n"}
    return value if plain and value.lower() not in words else json.dumps(value, ensure_ascii=False)


def unit_source(guess: ColumnGuess) -> str:
    """Where the unit of a column is from, in words."""
    if guess.unit_by == "size":
        return f"no unit in the files, and values stay within {MAX_RADIAN_RANGE:g}"
    return "unit from the file" if guess.unit_by == "file" else "no unit in the files"


def kind_reason(test: TestDraft) -> str:
    """Why a test is taken for its kind, in words."""
    guess = test.guess
    if guess.kind in IN_WAVES:
        return f"the wave column shows {guess.kind} waves"
    if guess.kind == "static":
        return "neither waves nor a decay seen, so not used"
    if guess.by_name:
        return f"{guess.degree_of_freedom} by the name of the file; the record shows another motion more"
    water = "still water" if guess.still_wave else "no wave column"
    part = "" if guess.window is None else " in the longest part without a gap"
    return f"{water}; {guess.degree_of_freedom} dies out{part}"


def _aligned(lines: Iterable[tuple[str, str]]) -> str:
    """Lines with their comments in one column."""
    lines = list(lines)
    width = max((len(text) for text, comment in lines if comment and len(text) <= MAX_COMMENT_COLUMN), default=0)
    return "".join(f"{text:<{width}}   # {comment}\n" if comment else f"{text}\n" for text, comment in lines)


def _channel(name: str, guess: ColumnGuess) -> str:
    return f"  {name + ':':<7}{{column: {yaml_scalar(guess.column)}, unit: {guess.unit}}}"


def _reason(guess: ColumnGuess, draft: CampaignDraft) -> str:
    if not draft.from_files:
        return "CHECK: column and unit"
    reason = "by its name" if guess.by == "name" else "the first column that rises"
    also = f"; or {', '.join(guess.others[:3])}" if guess.others else ""
    return f"CHECK: {reason}{also}; {unit_source(guess)}"


def _wave_channel(draft: CampaignDraft) -> str:
    wave = draft.columns.get(WAVE)
    if wave is None:
        line = "# wave_channel: {column: wave_m, unit: m, position: [0.0, 0.0]}"
        return f"{line}   # of tests in waves; position of the gauge: x, y in m\n"
    text = f"wave_channel: {{column: {yaml_scalar(wave.column)}, unit: {wave.unit}, position: [0.0, 0.0]}}"
    return f"{text}   # {_reason(wave, draft)}; position of the gauge (x, y in m) is not known\n"


def _zero(draft: CampaignDraft) -> str:
    if draft.still is None:
        return _NO_ZERO
    begin, end = draft.still
    where = "every file" if len(draft.tests) > 1 else "the file"
    return f"zero: {{window: [{begin:g}, {end:g}]}}   # CHECK: {where} begins at rest; motions count from there\n"


def _calibrate(draft: CampaignDraft) -> str:
    """Commented keys of the fit, with a coefficient of the platform as an example."""
    sizes = dict(draft.sizes or _EXAMPLE_SIZES)
    label, value = next(iter(sizes.items()))
    group = f"{label.split('.')[0]}.*"
    return (
        "# calibrate:                    # left out: all coefficients that are not 0 in platform.yaml\n"
        f'#   free: ["{group}"]   # which coefficients are fitted\n'
        f"#   fixed: [{list(sizes)[-1]}]   # which are not\n"
        f"#   bounds: {{{label}: [{0.2 * value:.3g}, {5 * value:.3g}]}}   # what is possible at all\n"
        f"#   priors: {{{label}: {{value: {value:.3g}, standard_deviation: {0.2 * abs(value):.3g}}}}}"
        "   # what is known from elsewhere\n"
    )


def _test_line(test: TestDraft) -> tuple[str, str]:
    guess = test.guess
    parts = [f"id: {yaml_scalar(test.id)}", f"kind: {guess.kind}"]
    if guess.degree_of_freedom is not None:
        parts.append(f"degree_of_freedom: {guess.degree_of_freedom}")
    if test.window is not None:
        parts.append(f"window: [{test.window[0]:.10g}, {test.window[1]:.10g}]")
    line = f"  - {{{', '.join((*parts, f'file: {yaml_scalar(test.file)}', f'use: {test.use}'))}"
    if not test.columns:
        return f"{line}}}", "CHECK: put this file here"
    held = f"; the last of {test.repeats} is held out" if test.use == "holdout" else ""
    further = f"\n     channels: {{{', '.join(_overrides(test))}}}}}" if test.overrides else ""
    return f"{line}{',' if further else '}'}", f"CHECK: {kind_reason(test)}{held}{further}"


def _overrides(test: TestDraft) -> Iterator[str]:
    """Columns of one test's own file, with their units."""
    for name, guess in test.overrides.items():
        yield f"{name}: null" if guess is None else f"{name}: {{column: {yaml_scalar(guess.column)}, unit: {guess.unit}}}"
