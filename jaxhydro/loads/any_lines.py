"""The loads that are mooring lines with a tension each."""

from jaxhydro.loads.catenary.catenary_lines import CatenaryLines
from jaxhydro.loads.mooring_lines import MooringLines
from jaxhydro.loads.tension_table_lines import TensionTableLines

AnyLines = MooringLines | CatenaryLines | TensionTableLines
"""Loads with a method `tension`: the tension of each line, and the unit vectors to the anchors."""
