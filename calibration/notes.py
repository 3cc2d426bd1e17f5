"""Notes on a result: sentences, each marked with its subject (records, fit, parameters)."""

from collections.abc import Iterable
from enum import StrEnum


class NoteKind(StrEnum):
    """What a note is about."""

    RECORDS = "records"
    FIT = "fit"
    PARAMETERS = "parameters"


class Note(str):
    """A sentence with its kind.

    Attributes:
        kind: What it is about.
    """

    kind: NoteKind

    def __new__(cls, text: str, kind: NoteKind) -> "Note":
        """A note; one that has a kind keeps it."""
        note = super().__new__(cls, text)
        note.kind = kind_of(text, kind)
        return note


def notes_of(kind: NoteKind, texts: Iterable[str]) -> tuple[Note, ...]:
    """Sentences as notes of a kind; those that have one keep it."""
    return tuple(Note(text, kind) for text in texts)


def kind_of(text: str, default: NoteKind = NoteKind.FIT) -> NoteKind:
    """Kind of a note; of a plain sentence the default."""
    return text.kind if isinstance(text, Note) else default
