"""What a candidate would gain if the model were linear in it: from one look, for the fitted and the held-out tests."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from calibration.discovery.descent import FLOOR, POWER
from calibration.discovery.study import Look, Prior, Study

ROUNDS = 6  # of weights


class Predicted(NamedTuple):
    """Steps of the columns asked for, gains of -2 ln L in the fitted and the held-out tests, and the covariance."""

    step: np.ndarray
    fitted: float
    held: float
    covariance: np.ndarray

    @property
    def deviation(self) -> np.ndarray:
        """Standard deviations."""
        return np.sqrt(np.maximum(np.diag(self.covariance), 0.0))


def predict(study: Study, look: Look, columns: Sequence[int], fitted: np.ndarray, prior: Prior) -> Predicted:
    """Let some columns of a look move (positions in `look.active`), releases and offsets with them, weights renewed."""
    columns = list(columns)
    q = len(look.active)
    active = [look.active[i] for i in columns]
    width = prior.width[active]
    begun = (study.steps(look.place.x) - prior.mean)[active]
    noise2 = np.array([one.noise for one in study.series])[:, None] ** 2
    before, dof = study.mean_squares(look)
    now = before
    r = c = b = 0
    if look.decays.size:
        r, c, b = look.decays.shape[:3]
        keep = np.r_[np.array(columns, int), q : look.decays.shape[-1]]
        decays = look.decays[..., keep[:, None], keep]
    keep = np.r_[np.array(columns, int), q]
    seas = [one[..., keep[:, None], keep] for one in look.seas]
    n = len(columns)
    step, inverse, powers = np.zeros(n), np.zeros((n, n)), look.power()
    for _ in range(ROUNDS):
        every = (dof > 0) * np.maximum(now, FLOOR) ** (POWER - 1) / noise2
        weight = every * fitted[:, None]
        matrix, right, back, at = np.diag(1 / width**2), begun / width**2, [], r * c
        if look.decays.size:
            mine = np.einsum("rcb,rcbkl->rkl", every[:at].reshape(r, c, b), decays)
            used = fitted[:at].reshape(r, c)[:, 0]
            for i, one in enumerate(mine):
                own = one[n:-1, n:-1] + np.diag(1 / study.own_width[i] ** 2)
                own = own + 1e-12 * np.eye(len(own)) * np.trace(own) / len(own)
                force = one[n:-1, -1] + look.place.own[i] / study.own_width[i] ** 2
                found = np.linalg.solve(own, np.column_stack([one[n:-1, :n], force]))
                back.append(found)
                if used[i]:
                    matrix = matrix + one[:n, :n] - one[n:-1, :n].T @ found[:, :-1]
                    right = right + one[:n, -1] - one[n:-1, :n].T @ found[:, -1]
        place = at
        for one in seas:
            m = one.shape[0] * one.shape[1]
            whole = np.einsum("wcb,wcbkl->kl", weight[place : place + m].reshape(one.shape[:3]), one)
            place += m
            matrix, right = matrix + whole[:n, :n], right + whole[:n, -1]
        scale = 1 / np.sqrt(np.diag(matrix))
        inverse = np.linalg.pinv(matrix * np.outer(scale, scale), rcond=1e-12, hermitian=True) * np.outer(scale, scale)
        step = -inverse @ right
        parts = []
        if look.decays.size:
            vectors = np.stack([np.concatenate([step, -(f[:, -1] + f[:, :-1] @ step), [1.0]]) for f in back])
            parts.append(np.einsum("rk,rcbkl,rl->rcb", vectors, decays, vectors).reshape(r * c, b))
        vector = np.concatenate([step, [1.0]])
        parts += [np.einsum("k,wcbkl,l->wcb", vector, one, vector).reshape(-1, one.shape[2]) for one in seas]
        powers = np.concatenate(parts) if parts else powers
        now = np.where(dof > 0, powers / np.where(dof > 0, dof, 1.0) / noise2, 0.0)
    gain = dof * (np.log(np.maximum(before, FLOOR)) - np.log(np.maximum(now, FLOOR)))
    return Predicted(step, float(gain[fitted].sum()), float(gain[~fitted].sum()), inverse)
