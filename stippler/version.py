"""The version of the program, as files and `stippler --version` tell it."""

VERSION = "0.1.0"
