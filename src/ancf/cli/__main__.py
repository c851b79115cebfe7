"""The command line as ``python -m ancf.cli``."""

from ancf.cli import main

main()
