"""The command line as ``python -m ancf.cli``."""

from ancf.cli.app import main

main()
