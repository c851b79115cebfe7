"""The command line as ``python -m ancf.cli``."""

from . import main

main()
