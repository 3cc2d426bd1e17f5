"""Check that the tables of a platform file cover the wave headings asked for."""

from typing import Any, NamedTuple

from jaxhydro.errors import InputError
from jaxhydro.interop.table_headings import covers, spoken, table_headings
from jaxhydro.interop.wamit_tables import same_heading


class OtherWaves(NamedTuple):
    """Table that was computed for other wave headings than one that is asked for.

    Attributes:
        key: Source of the headings: a key of the platform file, or the headings of a file.
        heading: The heading (deg), or headings in words.
    """

    key: str
    heading: float | str

    @property
    def words(self) -> str:
        """The heading or headings, in degrees."""
        return self.heading if isinstance(self.heading, str) else f"{self.heading:g}"


def other_waves(key: str, table: Any, kind: str, heading: float) -> OtherWaves | None:
    """Headings of a table that do not cover a wave heading; None where they do.

    Headings between those of a file are interpolated. A file that cannot be read is left for where it is loaded.

    Args:
        key: Key of the table in the platform file.
        table: Its contents there, with `file`, `heading`, `by` and `body`.
        kind: As in `table_headings`.
        heading: Direction that the waves travel to (deg).
    """
    if table.heading is not None:
        return None if same_heading(table.heading, heading) else OtherWaves(f"{key}.heading", table.heading)
    try:
        headings = table_headings(table.file, kind, table.by, table.body)
    except InputError:
        return None
    return None if covers(headings, heading) else OtherWaves(f"headings of {key}.file", spoken(headings))
