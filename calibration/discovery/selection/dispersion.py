"""By how much the likelihood of a linear model counts for less, where a fit leaves more than noise."""

import numpy as np

from calibration.discovery.score_covariance import MIN_DISCREPANCY, overdispersion, score_matrix, without_own
from calibration.discovery.selection.linear_model import LinearFit, LinearModel
from calibration.identifiability.information import pseudo_inverse


def dispersion(model: LinearModel, fit: LinearFit) -> float:
    """Number of degrees of freedom after a fit that count as one.

    A residual above the noise is the model's own error, and is alike in all records. Its samples therefore count as fewer
    independent observations (see `score_covariance`). At the noise they all count.

    Args:
        model: The linear model.
        fit: A fit of some of its columns.
    """
    residual = model.residual_after(fit)
    if (discrepancy := model.discrepancy(residual)) <= MIN_DISCREPANCY:
        return 1.0
    columns = np.array(fit.columns)[~fit.at_bound]
    root = np.sqrt((model.freedom / np.maximum(fit.levels, 1.0))[model.pool] * model.share)
    own = [(unknowns.rows, root[unknowns.rows, None] * unknowns.slopes, unknowns.width) for unknowns in model.own]
    rows = without_own(root[:, None] * model.slopes[:, columns], own)
    matrix, scores = rows.T @ rows, score_matrix(rows, root * residual, model.group)
    inverse = pseudo_inverse(matrix + np.diag(1 / model.width[columns] ** 2))
    return max(discrepancy, overdispersion(inverse, matrix, scores))
