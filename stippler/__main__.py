"""`python -m stippler`."""

from stippler.cli import program

program()
