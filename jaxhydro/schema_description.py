"""Description of a schema at the path where pydantic found an error."""

import types
from dataclasses import dataclass, replace
from enum import Enum
from typing import Annotated, Any, Literal, Union, get_args, get_origin

from pydantic import BaseModel, RootModel, Tag


@dataclass(frozen=True)
class SchemaLocation:
    """Where an error points: path in the file, declared type, value, and the keys allowed beside it."""

    where: str
    kind: Any
    notes: tuple[Any, ...]
    value: Any
    keys: tuple[str, ...] = ()
    description: str | None = None


def locate(model: Any, data: Any, detail: Any) -> SchemaLocation:
    """Location of a pydantic error in the file and in the declared types."""
    loc, lacks = [item for item in detail["loc"] if item != "[key]"], detail["type"] == "missing"
    if lacks and loc and isinstance(loc[-1], int):  # an element of a tuple: the tuple is what is wrong
        loc, lacks = loc[:-1], False
    location = SchemaLocation("", model, (), data)
    for i, item in enumerate(loc):
        kind, notes = bare(location.kind, location.notes)
        arm = next((arm for arm in arms_of(kind) if item in tags_of(arm)), None)
        if arm is not None:
            location = replace(location, kind=arm, notes=(), keys=())
            continue
        value, name = location.value, dotted(location.where, item)
        if isinstance(value, dict) and item in value:
            value = value[item]
        elif isinstance(value, list) and isinstance(item, int) and item < len(value):
            value, name = value[item], f"{location.where}[{item}]"
        elif lacks and i == len(loc) - 1:
            value = None
        else:
            name = location.where
        keys: tuple[str, ...] = ()
        description = None
        if isinstance(kind, type) and issubclass(kind, RootModel):
            kind, notes = bare(kind.model_fields["root"].annotation, ())
        if isinstance(kind, type) and issubclass(kind, BaseModel):
            fields = {field.alias or key: field for key, field in kind.model_fields.items()}
            keys, field = tuple(fields), fields.get(str(item))
            others = get_args(kind.__annotations__.get("__pydantic_extra__")) or (str, Any)  # of keys that are not declared
            kind, notes = (field.annotation, tuple(field.metadata)) if field else (others[1], ())
            description = field.description if field else None
        elif args := get_args(kind):  # the values of a mapping; the elements of a list are all of one type
            kind, notes = args[1 if get_origin(kind) is dict else 0], ()
        location = SchemaLocation(name, kind, notes, value, keys, description)
    return location


def dotted(parent: str, item: object) -> str:
    """The path of `item`, a key or an index as `[2]`, below `parent`."""
    name = item if isinstance(item, str) else repr(item) if isinstance(item, int) and abs(item) < 1e9 else "?"
    name = name if len(name) <= 200 else f"{name[:60]}..."
    return f"{parent}.{name}" if parent and name and not name.startswith("[") else f"{parent}{name}"


def bare(kind: Any, notes: tuple[Any, ...]) -> tuple[Any, tuple[Any, ...]]:
    """A declared type without Annotated and without `| None`, and what stood in Annotated."""
    while True:
        if get_origin(kind) is Annotated:
            kind, *more = get_args(kind)
            notes = (*notes, *more)
        elif get_origin(kind) in (Union, types.UnionType) and len(arms_of(kind)) == 1:
            kind = arms_of(kind)[0]
        else:
            return kind, notes


def arms_of(kind: Any) -> tuple[Any, ...]:
    """The alternatives of a union, None aside."""
    if get_origin(kind) not in (Union, types.UnionType):
        return ()
    return tuple(arm for arm in get_args(kind) if arm is not types.NoneType)


def tags_of(arm: Any) -> tuple[Any, ...]:
    """The tags that select an alternative: its Tag, or the literals its discriminator may have."""
    kind, notes = bare(arm, ())
    tags = tuple(note.tag for note in notes if isinstance(note, Tag))
    if tags or not (isinstance(kind, type) and issubclass(kind, BaseModel)):
        return tags
    literals = (field.annotation for field in kind.model_fields.values())
    return tuple(tag for literal in literals if get_origin(literal) is Literal for tag in get_args(literal))


def choices_of(kind: Any) -> tuple[str, ...]:
    """The words of a Literal or of an enumeration; empty for other types."""
    if isinstance(kind, type) and issubclass(kind, Enum):
        return tuple(str(member.value) for member in kind)
    return tuple(map(str, get_args(kind))) if get_origin(kind) is Literal else ()


_SIGNS = {"gt": ">", "ge": ">=", "lt": "<", "le": "<="}
_SCALARS: dict[Any, tuple[str, str]] = {  # one of it, several of it
    float: ("a number", "numbers"),
    int: ("a whole number", "whole numbers"),
    str: ("text", "texts"),
    bool: ("true or false", "values true or false"),
}


def words(kind: Any, notes: tuple[Any, ...], several: bool = False) -> str:
    """A declared type in plain words, with its bounds: `a number > 0`, `a list of 3 numbers`."""
    kind, notes = bare(kind, notes)
    if kind in _SCALARS:
        flat = [inner for note in notes for inner in getattr(note, "metadata", [note])]
        signs = ((sign, getattr(note, name, None)) for note in flat for name, sign in _SIGNS.items())
        bounds = " and ".join(f"{sign} {limit:g}" for sign, limit in signs if limit is not None)
        return f"{_SCALARS[kind][several]} {bounds}".strip()
    args, origin = get_args(kind), get_origin(kind)
    if options := choices_of(kind):
        return f"one of {', '.join(options)}"
    if origin in (tuple, list):
        count = "" if origin is list or args[-1] is Ellipsis else f"{len(args)} "
        return f"{'lists' if several else 'a list'} of {count}{words(args[0], (), several=True)}"
    if arms_of(kind):
        return " or ".join(dict.fromkeys(words(arm, (), several) for arm in arms_of(kind)))
    if several:
        return "mappings"
    if isinstance(kind, type) and issubclass(kind, BaseModel) and not issubclass(kind, RootModel):
        return f"a mapping with the keys {', '.join(kind.model_fields)}"
    return "a mapping"
