"""The version of regdb."""

VERSION = "0.1.0"
