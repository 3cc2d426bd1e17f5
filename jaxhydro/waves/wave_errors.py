"""Errors of seas that cannot be, by cause."""


class BreakingError(ValueError):
    """A wave is too steep: it would break."""


class BandError(ValueError):
    """A band of frequencies cannot be, or has no waves in it."""


class ShortWavesError(ValueError):
    """The shortest waves are too short for the region where a sea is needed."""


class StretchingError(ValueError):
    """A wave has its own flow above still water level and takes no stretching."""


class NoWaveError(ValueError):
    """No wave of the requested height and period is found."""


class GaugeSpacingError(ValueError):
    """Two wave gauges are where they cannot tell incident from reflected waves, or not where they are said to be.

    Attributes:
        expected: Positions that are expected.
        found: Positions that are found.
    """

    def __init__(self, expected: str, found: str) -> None:
        super().__init__(f"{expected} expected, found {found}")
        self.expected, self.found = expected, found
