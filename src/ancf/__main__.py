"""The command line as ``python -m ancf``."""

from .cli import main

main()
