"""`python -m stippler`."""

from stippler.cli import main

main()
