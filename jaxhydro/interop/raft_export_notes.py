"""Notes on members of a platform that are written for RAFT."""

from collections.abc import Iterator

from jaxhydro.interop.conversion import ConvertedItem, Treatment

TAKEN, APPROXIMATED, LEFT_OUT = Treatment.TAKEN, Treatment.APPROXIMATED, Treatment.LEFT_OUT


class RaftNotes:
    """Sentences about members, each with the names of the members that it holds for."""

    def __init__(self) -> None:
        """Begin without any."""
        self._names: dict[tuple[str, Treatment, str, bool], list[str]] = {}

    def add(self, name: str, keys: str, treatment: Treatment, meaning: str, warning: bool = False) -> None:
        """Say something about a member.

        Args:
            name: Its name.
            keys: Keys that it is about.
            treatment: What became of them.
            meaning: The sentence.
            warning: As in `ConvertedItem`.
        """
        names = self._names.setdefault((keys, treatment, meaning, warning), [])
        if name not in names:
            names.append(name)

    def items(self) -> Iterator[ConvertedItem]:
        """The sentences as items, in the order in which they came."""
        for (keys, treatment, meaning, warning), names in self._names.items():
            yield ConvertedItem(f"{keys}, {', '.join(names)}", treatment, meaning, warning)

    def diffraction(self, convention: str, name: str) -> None:
        """MacCamy and Fuchs' diffraction, by the convention of the model."""
        if convention == "ramp":
            self.add(name, "diffraction", TAKEN, "MCF, with the ramp to 1 + Ca in long waves, as here.")
        else:
            text = "MCF. In waves longer than 10 radii RAFT goes over to 1 + Ca; here diffraction holds in all waves."
            self.add(name, "diffraction", APPROXIMATED, text)

    def pierced(self, name: str) -> None:
        """A member that still water cuts lengthwise."""
        text = (
            "Still water cuts it lengthwise. RAFT has the whole member where its axis is under water, else nothing, and "
            "no waterplane of it. Replace it by upright members before RAFT is used."
        )
        self.add(name, "members: buoyancy and loads", LEFT_OUT, text, warning=True)

    def tapered_waterline(self, name: str) -> None:
        """A column whose size changes where still water cuts it."""
        text = (
            "Its size changes where still water cuts it. RAFT takes the size there with the ends of the section exchanged, so "
            "that its volume and waterplane are others."
        )
        self.add(name, "members: d", APPROXIMATED, text, warning=True)

    def tapered_box(self, name: str) -> None:
        """An upright box whose sides change along it."""
        text = "RAFT subtracts the added mass of the sides of a box that narrows upwards; here it is added, as of circles."
        self.add(name, "coefficients: Ca_z", APPROXIMATED, text)

    def moved_end(self, name: str, distance: float) -> None:
        """An end at z = 0."""
        self.add(name, "members: rA, rB", APPROXIMATED, f"RAFT refuses an end at z = 0: it is {1e3 * distance:g} mm higher.")

    def drag_of_boxes(self, name: str) -> None:
        """Drag of upright boxes."""
        text = (
            "Cd by direction, over ratios of the sides: RAFT refers drag to the side along the flow. The forces are the same."
        )
        self.add(name, "coefficients: Cd_t", TAKEN, text)

    def end_volumes(self, name: str) -> None:
        """Added mass of the ends of upright boxes."""
        text = "CaEnd, converted: RAFT refers it to a sphere on the mean side, here to the circle of equal area."
        self.add(name, "coefficients: Ca_z", TAKEN, text)

    def covered_ends(self, name: str) -> None:
        """Ends that other columns cover."""
        text = "CaEnd and CdEnd are those of the part of an end that no other column covers. `convert` does not read this back."
        self.add(name, "coefficients: Ca_z, Cd_z", TAKEN, text)
