"""OpenFAST's text files: lines of a value and its key, and tables under a count.

Values are found by their key, so that keys which a version of OpenFAST adds or lacks do no harm. `openfast_io` reads by line
number instead: it stops at decks of other versions, and at a deck whose blade file is not there.
"""

import math
import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from jaxtyping import Float

from jaxhydro.errors import InputError, Problem, shown
from jaxhydro.interop.openfast.table_row import FLAGS, TableRow, bare_word, to_number

Layouts = Mapping[int, Sequence[str]]  # number of columns -> their names
_WORD = re.compile(r'"[^"]*"|\'[^\']*\'|[^\s,;]+')
_KEY = re.compile(r"[A-Za-z_]\w*(\(\d+\))?")
_STATED = ("default", "unused", "none", *FLAGS)  # words that are values


@dataclass
class KeyedFile:
    """Lines of one of OpenFAST's files, and which of its keys were used.

    Attributes:
        path: The file.
        lines: Its lines.
        absent: Keys that were asked for and are not in this version, with what was taken in their place.
    """

    path: Path
    lines: list[str]
    absent: dict[str, str] = field(default_factory=dict)
    _indices: dict[str, int] = field(default_factory=dict)
    _keys: dict[int, str] = field(default_factory=dict)
    _used: set[int] = field(default_factory=set)

    def __post_init__(self) -> None:
        """Find the key of every line; the line under a file's heading is a description."""
        described = bool(self.lines) and self.lines[0].lstrip().startswith("---")
        for i, line in enumerate(self.lines):
            if described and i == 1:
                continue
            words = self.words(i)
            if len(words) < 2 or line.lstrip().startswith(("---", "===", "!", "#")):
                continue
            after = next((w for w in words[1:] if math.isnan(to_number(w)) and w[0] not in "\"'"), "")
            if _KEY.fullmatch(after):
                self._indices.setdefault(after.lower(), i)
                self._keys[i] = after

    @property
    def name(self) -> str:
        """Name of the file."""
        return self.path.name

    def words(self, index: int) -> list[str]:
        """Words of a line; quoted text is one."""
        return _WORD.findall(self.lines[index]) if index < len(self.lines) else []

    def _text(self, index: int) -> str:
        """What a line says, for an error."""
        return shown(self.lines[index].strip()) if index < len(self.lines) else "the end of the file"

    def wrong(self, index: int | None, expected: str, found: str, hint: str = "", key: str = "") -> InputError:
        """The error of a line, or of the file."""
        where = f"line {index + 1}" if index is not None else ""
        return InputError(str(self.path), [Problem(", ".join(filter(None, (where, key))), expected, found, hint)])

    def has(self, key: str) -> bool:
        """Whether this version of the file has a key."""
        return key.lower() in self._indices

    def line_of(self, key: str) -> int:
        """Index of the line of a key.

        Raises:
            InputError: The file has no such key.
        """
        if not self.has(key):
            raise self.wrong(None, f"a line with a value and {key}", "none", key=key)
        index = self._indices[key.lower()]
        self._used.add(index)
        return index

    def word(self, key: str, default: str | None = None) -> str:
        """Value of a key as text, without quotes.

        Args:
            key: The key.
            default: What is taken where this version has no such key; None: it is needed.

        Raises:
            InputError: The key is needed and not there.
        """
        if default is not None and not self.has(key):
            self.absent[key] = default
            return default
        return bare_word(self.words(self.line_of(key))[0])

    def number(self, key: str, default: float | None = None, standard: float | None = None) -> float:
        """Value of a key as a number.

        Args:
            key: The key.
            default: What is taken where this version has no such key; None: it is needed.
            standard: What the word DEFAULT means; None: a number is needed.

        Raises:
            InputError: It is no finite number, or is needed and not there.
        """
        word = self.word(key, None if default is None else f"{default:g}")
        if standard is not None and word.lower() == "default":
            return standard
        value = to_number(word)
        if not math.isfinite(value):
            raise self.wrong(self.line_of(key), "a number", shown(word), key=key)
        return value

    def whole(self, key: str, default: int | None = None) -> int:
        """Value of a key as a whole number.

        Raises:
            InputError: It is none, or is needed and not there.
        """
        value = self.number(key, default)
        if value != int(value):
            raise self.wrong(self.line_of(key), "a whole number", shown(self.word(key)), key=key)
        return int(value)

    def flag(self, key: str, default: bool | None = None) -> bool:
        """Value of a key as a logical value.

        Raises:
            InputError: It is neither true nor false, or is needed and not there.
        """
        word = self.word(key, None if default is None else str(default))
        if word.lower() not in FLAGS:
            raise self.wrong(self.line_of(key), "True or False", shown(word), key=key)
        return FLAGS[word.lower()]

    def vector(self, key: str, size: int) -> Float[np.ndarray, " size"]:
        """Numbers of a key: in its own line, or one in each line from it on.

        Raises:
            InputError: There are fewer numbers.
        """
        index = self.line_of(key)
        if math.isfinite(to_number([*self.words(index), ""][1])):
            return self.matrix(key, 1, size)[0]
        return self.matrix(key, size, 1)[:, 0]

    def matrix(self, key: str, rows: int, columns: int) -> Float[np.ndarray, "rows columns"]:
        """Numbers of a key in the lines from it on.

        Raises:
            InputError: There are fewer numbers.
        """
        index = self.line_of(key)
        values = [[to_number(word) for word in self.words(index + i)[:columns]] for i in range(rows)]
        for i, row in enumerate(values):
            if len(row) < columns or not np.isfinite(row).all():
                raise self.wrong(index + i, f"row {i + 1} of {rows} of {key}, {columns} numbers", self._text(index + i))
        self._used.update(range(index, index + rows))
        return np.array(values)

    def table(self, keys: str | Sequence[str], layouts: Layouts, header: str = "") -> list[TableRow]:
        """Rows of a table; none where this version has no such table.

        OpenFAST reads columns by their place. The header says how many there are; where it is abbreviated, the row does.

        Args:
            keys: Names of the count in different versions.
            layouts: Columns by their number.
            header: First word of the header; "" where the header follows the count.

        Raises:
            InputError: The table is shorter than its count, or has other columns.
        """
        key = next((key for key in ([keys] if isinstance(keys, str) else keys) if self.has(key)), None)
        if key is None:
            return []
        count, head = self.whole(key), self._header(header) if header else self.line_of(key) + 1
        if head is None:
            raise self.wrong(None, f"a table under a header that begins with {header}", "none")
        self._used.update(range(head, head + 2 + count))
        return [self._row(head, head + 2 + i, f"row {i + 1} of {count} of {key}", layouts) for i in range(count)]

    def _header(self, word: str) -> int | None:
        """Index of the first line that begins with a word, or None."""
        return next((i for i in range(len(self.lines)) if self.words(i)[:1] == [word]), None)

    def word_rows(self, key: str) -> list[tuple[int, list[str]]]:
        """Index and words of the rows of a table of as many columns as every row says.

        Raises:
            InputError: The table is shorter than its count.
        """
        if not self.has(key):
            return []
        start, count = self.line_of(key), self.whole(key)
        self._used.update(range(start, start + 3 + count))
        rows = [(start + 3 + i, self.words(start + 3 + i)) for i in range(count)]
        for i, (index, words) in enumerate(rows):
            if not words or math.isnan(to_number(words[0])):
                raise self.wrong(index, f"row {i + 1} of {count} of {key}", self._text(index))
        return rows

    def table_under(self, header: str, layouts: Layouts) -> TableRow | None:
        """The one row under a header whose first word is given, or None."""
        if (head := self._header(header)) is None:
            return None
        self._used.update(range(head, head + 3))
        return self._row(head, head + 2, f"the row of {header}", layouts)

    def _row(self, header: int, index: int, description: str, layouts: Layouts) -> TableRow:
        words = self.words(index)
        if index >= len(self.lines) or not words or math.isnan(to_number(words[0])):
            raise self.wrong(min(index, len(self.lines) - 1), description, self._text(index))
        names = self.words(header)
        stated = next((i for i, name in enumerate(names) if name.startswith(("[", "!"))), len(names))
        count = stated if stated in layouts and len(names) > 2 else len(words)
        if count not in layouts:
            count = max((n for n in layouts if n <= len(words)), default=0)
        if count == 0 or len(words) < count:
            expected = f"{description}, {count or min(layouts)} columns"
            raise self.wrong(index, expected, f"{len(words)}")
        cells = dict(zip(layouts[count], words, strict=False))
        return TableRow(str(self.path), index + 1, {name: bare_word(word) for name, word in cells.items()})

    def use(self, indices: Iterable[int]) -> None:
        """Count lines as used."""
        self._used.update(indices)

    def unused(self) -> list[str]:
        """Keys with a value that were not used, in the order of the file."""
        keys = []
        for i, key in self._keys.items():
            first = self.words(i)[0]
            value = math.isfinite(to_number(first)) or first[0] in "\"'" or first.lower() in _STATED
            if i not in self._used and value and key.lower() not in FLAGS and key.lower() not in _STATED:
                keys.append(key)
        return list(dict.fromkeys(keys))
