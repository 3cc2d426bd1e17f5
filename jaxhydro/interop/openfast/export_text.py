"""Text of OpenFAST's files: templates, and numbers as Fortran reads them."""

from typing import Any

import numpy as np
from jinja2 import Environment, PackageLoader, StrictUndefined

from jaxhydro.interop.openfast.mass_parts import tidy

TEMPLATES = Environment(
    loader=PackageLoader("jaxhydro.interop.openfast"),
    undefined=StrictUndefined,
    trim_blocks=True,
    lstrip_blocks=True,
    keep_trailing_newline=True,
    autoescape=False,
)


def filled(template: str, **values: Any) -> str:
    """Text of a template of this package."""
    return TEMPLATES.get_template(f"{template}.j2").render(**values)


def digits(value: Any) -> str:
    """A number with 12 digits, as Fortran reads it."""
    return repr(tidy(float(value)))


def row(*values: Any) -> str:
    """Numbers and words of a row of a table; whole numbers stay whole."""
    return " ".join(digits(value) if isinstance(value, float | np.floating) else str(value) for value in values)
