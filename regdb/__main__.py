"""`python -m regdb`."""

from regdb.cli import main

main()
