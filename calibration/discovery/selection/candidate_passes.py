"""Passes of a linearisation along candidate effects: which candidates share one, and at which values of their shapes."""

from collections.abc import Mapping, Sequence

from calibration.discovery.effect_fits import EffectFits
from calibration.discovery.effects.candidates import Candidate
from calibration.discovery.linearisations import Point
from calibration.discovery.search import ListedVariant

CandidateValues = tuple[Candidate, Mapping[str, float]]  # a candidate at values of its shapes


def is_nearly_known(fits: EffectFits, candidate: Candidate) -> bool:
    """Whether every fit moves the amplitudes of a candidate, which then needs no pass of its own.

    Args:
        fits: Study, candidates, priors.
        candidate: The candidate.
    """
    return set(fits.study.index(candidate.amplitudes)) <= set(fits.base)


def first_passes(
    fits: EffectFits, candidates: Sequence[Candidate], among: Sequence[ListedVariant] | None = None
) -> tuple[list[list[CandidateValues]], list[CandidateValues]]:
    """Passes along the candidates whose further shapes are found from slopes, and the candidates that are left.

    What the passes have no room for goes with the shapes that are found.

    Args:
        fits: Study, candidates, priors.
        candidates: The candidates.
        among: Which of them, at values of their shapes; None: all.
    """
    declared = [(one, at) for one in candidates if not is_nearly_known(fits, one) for at in one.grid or ({},)]
    declared = [(one, at) for one, at in declared if among is None or any(is_listed(one, at, it) for it in among)]
    passes = packed(sorted(declared, key=lambda pair: pair[0].shape_finder is None), fits.study.width)
    first = [some for i, some in enumerate(passes) if i == 0 or any(one.shape_finder is not None for one, _ in some)]
    return first, [pair for some in passes[len(first) :] for pair in some]


def jobs_of(
    fits: EffectFits, place: Point, active: Sequence[int], passes: Sequence[Sequence[CandidateValues]]
) -> list[tuple[Point, tuple[int, ...]]]:
    """Points and directions of passes along candidates.

    Args:
        fits: Study, candidates, priors.
        place: The point of the model.
        active: The model's own directions, which are left out.
        passes: Candidates and values of their shapes.
    """
    jobs = []
    for some in passes:
        point = fits.with_values(place, {k: v for _, at in some for k, v in at.items()})
        free = dict.fromkeys(i for one, _ in some for i in fits.study.index(one.amplitudes) if i not in active)
        jobs.append((point, tuple(free)))
    return jobs


def is_listed(one: Candidate, at: Mapping[str, float], entry: ListedVariant) -> bool:
    """Whether an entry of a list means a candidate at declared values of its shapes; one with other values means all."""
    other = entry.values not in (one.grid or ({},))
    return one.name == entry.name and (one.shape_finder is not None or other or entry.values == at)


def packed(some: Sequence[CandidateValues], width: int) -> list[list[CandidateValues]]:
    """Candidates at values of their shapes in as few passes as possible, in their order.

    A pass has every candidate at one of its values at most, and at most so many directions.

    Args:
        some: Candidates and values.
        width: Directions of a pass.
    """
    passes: list[list[CandidateValues]] = []
    for one, at in some:
        for taken in passes:
            room = width - sum(len(other.amplitudes) for other, _ in taken)
            if len(one.amplitudes) <= room and all(other is not one for other, _ in taken):
                taken.append((one, at))
                break
        else:
            passes.append([(one, at)])
    return passes
