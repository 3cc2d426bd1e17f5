"""Notes on members for the items of a conversion, one note for several members."""

from collections.abc import Iterator

from jaxhydro.interop.conversion import ConvertedItem, Treatment


class MemberNotes:
    """Sentences about members, each with the numbers of the members that it holds for."""

    def __init__(self, source: str) -> None:
        """Begin without any.

        Args:
            source: Name of the file.
        """
        self.source = source
        self._numbers: dict[tuple[str, Treatment, str], list[int]] = {}

    def add(self, number: int, keys: str, treatment: Treatment, meaning: str) -> None:
        """Say something about a member or a joint.

        Args:
            number: MemberID or JointID.
            keys: Keys that it is about.
            treatment: What became of them.
            meaning: The sentence.
        """
        numbers = self._numbers.setdefault((keys, treatment, meaning), [])
        if number not in numbers:
            numbers.append(number)

    def items(self, label: str = "members") -> Iterator[ConvertedItem]:
        """The sentences as items, in the order in which they came."""
        for (keys, treatment, meaning), numbers in self._numbers.items():
            shown = ", ".join(map(str, numbers[:12])) + (f" and {len(numbers) - 12} more" if len(numbers) > 12 else "")
            yield ConvertedItem(f"{self.source}: {keys}, {label} {shown}", treatment, meaning)
