"""Products of the columns of a linear model over rows of equal weight (pools).

A pool's rows share one weight. So the products of the columns in each pool are enough for least squares with any weights. They
also give the mean square of every pool after any step. The rows are needed once.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np


class OwnUnknowns(NamedTuple):
    """A decay's own unknowns.

    Attributes:
        rows: Rows of the decay.
        slopes: Slopes along them (m, o).
        width: Standard deviations of their priors (o,).
        value: Present values (o,).
    """

    rows: slice
    slopes: np.ndarray
    width: np.ndarray
    value: np.ndarray


class OwnProducts(NamedTuple):
    """Products of a decay's own unknowns in its pools.

    Attributes:
        pools: Numbers of the decay's pools (q,).
        cross: With the columns (o, k, q).
        inner: With each other (o, o, q).
    """

    pools: np.ndarray
    cross: np.ndarray
    inner: np.ndarray


class WeightedSums(NamedTuple):
    """Weighted sums of products over all pools; the last column is the residual.

    Attributes:
        whole: Products of the columns (k, k).
        own: By decay: products of its own unknowns with the columns (o, k), and with each other (o, o).
    """

    whole: np.ndarray
    own: tuple[tuple[np.ndarray, np.ndarray], ...]

    def moved(self, step: np.ndarray, own_steps: Sequence[np.ndarray]) -> "WeightedSums":
        """The sums with the residual after steps.

        Args:
            step: Coefficients of all columns (k,); 1 for the residual.
            own_steps: Steps of every decay's own unknowns.
        """

        def after(sums: np.ndarray) -> np.ndarray:
            return np.column_stack([sums[:, :-1], sums @ step])

        whole, each = after(after(self.whole).T), []
        for (cross, inner), y in zip(self.own, own_steps, strict=True):
            moved = after(cross)
            along = moved.T @ y
            along[-1] += y @ inner @ y / 2
            whole[-1] += along
            whole[:, -1] += along
            each.append((np.column_stack([moved[:, :-1], moved[:, -1] + inner @ y]), inner))
        return WeightedSums(whole, tuple(each))


@dataclass(frozen=True)
class PooledProducts:
    """Products of columns by pool; the last column is the residual.

    Attributes:
        pools: Numbers of the pools that have rows (p,).
        whole: Products of the columns (k, k, p).
        own: Products of every decay's own unknowns.
    """

    pools: np.ndarray
    whole: np.ndarray
    own: tuple[OwnProducts, ...]

    @classmethod
    def of(
        cls, columns: np.ndarray, own_unknowns: Sequence[OwnUnknowns], pool: np.ndarray, share: np.ndarray
    ) -> "PooledProducts":
        """Products of columns.

        Args:
            columns: The columns (n, k).
            own_unknowns: The decays' own unknowns.
            pool: Pool of every row (n,).
            share: Weight of every row in its pool (n,); rows without weight are left out.
        """
        root = np.sqrt(share)
        scaled = root[:, None] * columns
        pools, member = np.unique(np.where(share > 0, pool, -1), return_inverse=True)
        first = int(pools[0] == -1) if len(pools) else 0
        rows = [np.flatnonzero(member == i) for i in range(first, len(pools))]
        whole = np.empty((len(rows), columns.shape[1], columns.shape[1]))
        for products, mine in zip(whole, rows, strict=True):
            np.matmul(scaled[mine].T, scaled[mine], out=products)
        each = []
        for unknowns in own_unknowns:
            inside = [(i, mine[(mine >= unknowns.rows.start) & (mine < unknowns.rows.stop)]) for i, mine in enumerate(rows)]
            inside = [(i, mine) for i, mine in inside if len(mine)]
            along = [(root[mine, None] * unknowns.slopes[mine - unknowns.rows.start], scaled[mine]) for _, mine in inside]
            cross = np.stack([side.T @ block for side, block in along], axis=-1)
            inner = np.stack([side.T @ side for side, _ in along], axis=-1)
            each.append(OwnProducts(np.array([i for i, _ in inside]), cross, inner))
        return cls(pools[first:], np.ascontiguousarray(whole.transpose(1, 2, 0)), tuple(each))

    def combined(self, columns: Sequence[int], last: np.ndarray) -> "PooledProducts":
        """Products of some columns and, as the last one, of a combination of all columns.

        Args:
            columns: Numbers of the columns (m,).
            last: Coefficients of the combination (k,).
        """
        parts = np.flatnonzero(last)
        taken, m = [*columns, *parts], len(columns)
        basis = np.zeros((len(taken), m + 1))
        basis[range(m), range(m)] = 1.0
        basis[m:, m] = last[parts]

        def both(products: np.ndarray) -> np.ndarray:
            """The second axis of products combined."""
            if len(parts) == 1 and basis[-1, -1] == 1.0:
                return products
            return np.concatenate([products[:, :m], np.tensordot(products[:, m:], basis[m:, m], (1, 0))[:, None]], axis=1)

        whole = both(both(self.whole[np.ix_(taken, taken)]).swapaxes(0, 1)).swapaxes(0, 1)
        own_products = tuple(
            OwnProducts(products.pools, both(products.cross[:, taken]), products.inner) for products in self.own
        )
        return PooledProducts(self.pools, whole, own_products)

    def weighted(self, weight: np.ndarray) -> WeightedSums:
        """Sums over all pools with weights (p,)."""
        own_sums = tuple(
            (products.cross @ weight[products.pools], products.inner @ weight[products.pools]) for products in self.own
        )
        return WeightedSums(self.whole @ weight, own_sums)

    def levels(self, step: np.ndarray, own_steps: Sequence[np.ndarray]) -> np.ndarray:
        """Sum of squares in every pool (p,) after steps.

        Args:
            step: Coefficients of all columns (k,).
            own_steps: Steps of every decay's own unknowns.
        """
        squares = np.tensordot(np.outer(step, step), self.whole, 2)
        for products, y in zip(self.own, own_steps, strict=True):
            cross = np.tensordot(np.outer(y, step), products.cross, 2)
            squares[products.pools] += 2 * cross + np.tensordot(np.outer(y, y), products.inner, 2)
        return np.maximum(squares, 0.0)  # rounding
