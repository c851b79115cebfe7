"""The examples of Gerstmayr and Shabana (2006): models, figures and their tables.

``reproduce(["fig2"], "out")`` writes a picture, a CSV and a JSON; ``cantilever``, ``pendulum`` and
``spin_up`` build the models of examples 7.1, 7.2 and 7.3.
"""

from .figures import FIGURES
from .reproduce import reproduce
from .table import Table

__all__ = ["FIGURES", "Table", "reproduce"]
