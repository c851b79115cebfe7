"""The examples of Gerstmayr and Shabana (2006): models, figures and their tables.

``reproduce(["fig2"], "out")`` writes a picture, a CSV and a JSON; ``verify`` does, compares the numbers with
their references, and writes a page. ``cantilever``, ``pendulum`` and ``spin_up`` build the models of
examples 7.1, 7.2 and 7.3.
"""

from .figures import FIGURES
from .reproduce import reproduce, resolve, verify
from .table import Table

__all__ = ["FIGURES", "Table", "reproduce", "resolve", "verify"]
