"""Padded array sizes, so that records of similar length share one compiled program."""

SIZES_PER_OCTAVE = 4  # of an octave


def padded_size(count: int) -> int:
    """Return the least of 1, 1.25, 1.5 and 1.75 times a power of two that holds `count` items."""
    if count <= SIZES_PER_OCTAVE:
        return max(count, 1)
    part = 1 << ((count - 1).bit_length() - 3)
    return -(-count // part) * part
