"""Which candidates are linearised together, and at which values of their shapes."""

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
    """First passes, along the candidates whose further shapes are found from slopes.

    Candidates for which these passes have no room are linearised later, with the shapes that are found.

    Args:
        fits: Study, candidates, priors.
        candidates: The candidates.
        among: Which of them, at values of their shapes; None: all.

    Returns:
        The first passes, and the candidates that are left.
    """
    pairs = [
        (candidate, values)
        for candidate in candidates
        if not is_nearly_known(fits, candidate)
        for values in candidate.grid or ({},)
    ]
    pairs = [
        (candidate, values)
        for candidate, values in pairs
        if among is None or any(is_listed(candidate, values, entry) for entry in among)
    ]
    passes = packed(sorted(pairs, key=lambda pair: pair[0].shape_finder is None), fits.study.width)
    first = [
        members
        for i, members in enumerate(passes)
        if i == 0 or any(candidate.shape_finder is not None for candidate, _ in members)
    ]
    return first, [pair for members in passes[len(first) :] for pair in members]


def jobs_of(
    fits: EffectFits, point: Point, active: Sequence[int], passes: Sequence[Sequence[CandidateValues]]
) -> list[tuple[Point, tuple[int, ...]]]:
    """Points and directions of passes along candidates.

    Args:
        fits: Study, candidates, priors.
        point: The point of the model.
        active: The model's own directions, which are left out.
        passes: Candidates and values of their shapes.
    """
    jobs = []
    for members in passes:
        pass_point = fits.with_values(point, {k: v for _, values in members for k, v in values.items()})
        free = dict.fromkeys(i for candidate, _ in members for i in fits.study.index(candidate.amplitudes) if i not in active)
        jobs.append((pass_point, tuple(free)))
    return jobs


def is_listed(candidate: Candidate, values: Mapping[str, float], entry: ListedVariant) -> bool:
    """Whether an entry of a list refers to a candidate at the given values of its shapes.

    An entry with values outside the candidate's grid refers to all values. So does any entry of a candidate whose further
    shapes are found from slopes.
    """
    has_other_values = entry.values not in (candidate.grid or ({},))
    return candidate.name == entry.name and (candidate.shape_finder is not None or has_other_values or entry.values == values)


def packed(candidates: Sequence[CandidateValues], width: int) -> list[list[CandidateValues]]:
    """Candidates at values of their shapes in as few passes as possible, in their order.

    A pass has every candidate at one of its values at most, and at most `width` directions.

    Args:
        candidates: Candidates and values.
        width: Directions of a pass.
    """
    passes: list[list[CandidateValues]] = []
    for candidate, values in candidates:
        for taken in passes:
            room = width - sum(len(member.amplitudes) for member, _ in taken)
            if len(candidate.amplitudes) <= room and all(member is not candidate for member, _ in taken):
                taken.append((candidate, values))
                break
        else:
            passes.append([(candidate, values)])
    return passes
