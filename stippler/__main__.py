"""`python -m stippler`."""

from stippler.start import program

program()
