"""Schemas of input files: types of values, reading of YAML, and validation with the path of each mistake."""

import warnings
from collections.abc import Iterator
from dataclasses import replace
from os import PathLike
from pathlib import Path
from typing import Annotated, Any, Self, TypeVar

from pydantic import BaseModel, ConfigDict, Field, ValidationError, model_validator
from ruamel.yaml import YAML
from ruamel.yaml.constructor import DuplicateKeyError
from ruamel.yaml.error import MarkedYAMLError
from ruamel.yaml.reader import ReaderError

from jaxhydro.choices import nearest
from jaxhydro.errors import Faults, InputError, Problem, shown, suggest, suggest_path
from jaxhydro.schema_description import SchemaLocation, arms_of, bare, choices_of, dotted, locate, tags_of, words

Number = Annotated[float, Field(strict=True, allow_inf_nan=False)]
Positive = Annotated[float, Field(strict=True, allow_inf_nan=False, gt=0)]
NonNegative = Annotated[float, Field(strict=True, allow_inf_nan=False, ge=0)]
Count = Annotated[int, Field(strict=True, ge=1, le=1000)]
Flag = Annotated[bool, Field(strict=True)]
Seed = Annotated[int, Field(strict=True, ge=0, le=2**63 - 1)]
MAX_SPREADING = 1e4
Gamma = Annotated[float, Field(strict=True, ge=1, le=7)]  # peak enhancement of JONSWAP
Spreading = Annotated[float, Field(strict=True, ge=0, le=MAX_SPREADING)]  # exponent s
Text = Annotated[str, Field(strict=True, min_length=1)]
Vector = tuple[Number, Number, Number]

M = TypeVar("M", bound=BaseModel)
# keys by which files tell their kind
KEYS = {"platform": {"members", "rigid_body"}, "campaign": {"tests", "channels"}, "sweep": {"scatter", "seeds"}}


class Schema(BaseModel):
    """Base class of schemas of users' files: immutable, without undeclared keys."""

    model_config = ConfigDict(frozen=True, extra="forbid")


class Consistent(Schema):
    """Base class of schemas whose keys must fit together.

    `_faults` yields what does not fit, once every key is right by itself.
    """

    @model_validator(mode="after")
    def _fits_together(self) -> Self:
        if faults := tuple(self._faults()):
            raise Faults(*faults)
        return self

    def _faults(self) -> Iterator[Problem]:
        raise NotImplementedError


def read_yaml(path: str | PathLike[str], kind: str = "") -> dict[Any, Any]:
    """Mapping in a YAML 1.2 file, as plain dicts, lists and scalars.

    Args:
        path: The file.
        kind: Kind of file that is expected, of `KEYS`; "" for any.

    Raises:
        InputError: The file cannot be read, is not a mapping, or is of another kind.
    """
    source = str(path)

    def wrong(where: str, expected: str, found: str, hint: str = "") -> InputError:
        return InputError(source, [Problem(where, expected, found, hint)])

    try:
        text = Path(path).read_bytes().decode("utf-8-sig")
    except FileNotFoundError:
        raise wrong("", "a YAML file", "no such file", suggest_path(path)) from None
    except IsADirectoryError:
        raise wrong("", "a YAML file", "a folder") from None
    except UnicodeDecodeError as error:
        line = error.object.count(b"\n", 0, error.start) + 1
        raise wrong(f"line {line}", "text in UTF-8", f"the byte 0x{error.object[error.start]:02x}") from None
    except (OSError, ValueError) as error:
        raise wrong("", "a readable YAML file", str(getattr(error, "strerror", None) or error)) from None
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            data = YAML(typ="safe", pure=True).load(text)
    except MarkedYAMLError as error:
        mark = error.problem_mark or error.context_mark
        where = f"line {mark.line + 1}, column {mark.column + 1}" if mark else ""
        mistake = " ".join(str(error.problem or error.context).split()).removeprefix("but ")[:160]
        if isinstance(error, DuplicateKeyError):
            raise wrong(where, "each key once", mistake.removeprefix("found ")) from None
        hint = "Indent by spaces: YAML takes no tabs." if "'\\t'" in mistake else ""
        raise wrong(where, "valid YAML", f"a mistake in its syntax ({mistake})", hint) from None
    except ReaderError as error:
        line = text.count("\n", 0, error.position) + 1
        raise wrong(f"line {line}", "text", f"the control character 0x{ord(text[error.position]):02x}") from None
    except RecursionError:
        raise wrong("", "valid YAML", "lists or mappings nested too deeply") from None
    except Exception as error:  # the YAML reader lets errors of the values it makes through (dates, tags)
        raise wrong("", "valid YAML", f"a value that cannot be read ({shown(str(error))})") from None
    if not isinstance(data, dict):
        data_file = kind and isinstance(data, str) and "," in data
        hint = f"Name the {kind} file, not a file of data." if data_file else ""
        raise wrong("", "a mapping of keys to values", "an empty file" if data is None else shown(data), hint)
    others = [name for name, keys in KEYS.items() if keys & data.keys()]
    if kind and others and kind not in others:
        raise wrong("", f"a {kind} file ({', '.join(sorted(KEYS[kind]))})", f"a {others[0]} file")
    return data


def validate(model_class: type[M], data: object, source: str) -> M:
    """Validated contents of a file.

    Args:
        model_class: Schema.
        data: Contents to validate.
        source: Name of the file, for errors.

    Raises:
        InputError: The contents have mistakes; all of them are listed.
    """
    try:
        return model_class.model_validate(data)
    except ValidationError as error:
        details = error.errors(include_url=False)
    problems: list[Problem] = []
    misspelt: set[str] = set()  # `masss: 1` is not also a missing `mass`
    for detail in details:
        loc = detail["loc"]
        if detail["type"] == "too_short" and any(d["loc"][: len(loc)] == loc != d["loc"] for d in details):
            continue  # pydantic counts only the elements that are right
        location = locate(model_class, data, detail)
        problems += _told(detail, location)
        if detail["type"] == "extra_forbidden":
            misspelt.add(dotted(location.where.rpartition(".")[0], nearest(loc[-1], location.keys)))
    raise InputError(source, dict.fromkeys(p for p in problems if p.found != "nothing" or p.where not in misspelt))


def _told(detail: Any, location: SchemaLocation) -> Iterator[Problem]:
    cause = detail.get("ctx", {}).get("error")
    if isinstance(cause, Faults):
        for problem in cause.problems:
            yield replace(problem, where=dotted(location.where, problem.where))
    elif cause is not None:
        yield Problem(location.where, str(cause), shown(location.value))
    elif detail["type"] in ("extra_forbidden", "invalid_key"):
        key = detail["loc"][-1]
        yield Problem(location.where, f"a known key ({', '.join(location.keys)})", shown(key), suggest(key, location.keys))
    elif "[key]" in detail["loc"]:
        key = detail["loc"][-2]
        comma = f" Or is it a decimal comma? Numbers have a point: 5.{key}, not 5,{key}." if isinstance(key, int) else ""
        yield Problem(location.where, "a key that is text", shown(key), f"Put it in quotes.{comma}")
    elif detail["type"].startswith("union_tag") and isinstance(location.value, dict):
        key = detail["ctx"]["discriminator"].strip("'")
        tags = [str(tag) for arm in arms_of(bare(location.kind, location.notes)[0]) for tag in tags_of(arm)]
        value = location.value.get(key)
        yield Problem(dotted(location.where, key), f"one of {', '.join(tags)}", shown(value), suggest(value, tags))
    else:
        expected = location.description or words(location.kind, location.notes)
        if detail["type"] == "finite_number":
            expected = expected.replace("a number", "a finite number")
        if detail["type"] == "string_too_short":
            expected += " that is not empty"
        elif detail["type"] == "too_short":
            expected += f" ({detail['ctx']['min_length']} or more)"
        yield Problem(location.where, expected, shown(location.value), _way_out(detail, location))


def _way_out(detail: Any, location: SchemaLocation) -> str:
    kind, value = bare(location.kind, location.notes)[0], location.value
    if options := choices_of(kind):
        return suggest(value, options)
    if kind is str and value is not None and not isinstance(value, dict | list | str):
        return "Put it in quotes to make it text."
    if isinstance(value, str) and detail["type"] in ("float_type", "int_type"):
        try:
            float(value)
        except ValueError:
            return ""
        return "Write the number without quotes, as 12.5 or 1.0e6; not .nan or .inf."
    return ""
