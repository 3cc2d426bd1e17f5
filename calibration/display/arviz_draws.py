"""Draws of parameters as ArviZ's inference data (an extra: pip install jaxhydro[arviz])."""

from typing import TYPE_CHECKING

import numpy as np

import jaxhydro
from calibration.uncertainty.bootstrap_draws import Bootstrap
from calibration.uncertainty.posterior_samples import Samples

if TYPE_CHECKING:
    from arviz import InferenceData


def inference_data(draws: Bootstrap | Samples) -> "InferenceData":
    """Values of all parameters by chain and draw, in their own units.

    Draws of a bootstrap are one chain. They stand in the group `posterior` too, where ArviZ looks for draws, although they are
    a sampling distribution; the attribute `method` says so.

    Args:
        draws: Draws of a bootstrap or of the posterior.

    Returns:
        Inference data whose group `posterior` has a variable for each parameter.

    Raises:
        ImportError: ArviZ is not installed.
    """
    try:
        from arviz import from_dict
    except ImportError as error:
        raise ImportError("to_arviz needs ArviZ: pip install 'jaxhydro[arviz]'") from error
    value = np.asarray(draws.value)
    value = value[None] if value.ndim == 2 else value
    if isinstance(draws, Bootstrap):
        about = {"method": f"bootstrap over {draws.method}", "seed": draws.seed, "unsettled": draws.unsettled}
    else:
        about = {"method": "NUTS", "seed": draws.seed, "divergences": draws.divergences}
    data = from_dict(
        posterior={label: value[..., i] for i, label in enumerate(draws.labels)},
        posterior_attrs={**about, "source": f"jaxhydro {jaxhydro.__version__}"},
    )
    model = draws.likelihood.fit.decays.problem.model
    for label in draws.labels:
        description = model.about(label)
        data.posterior[label].attrs |= {"units": description.unit, "long_name": description.meaning}
    return data
