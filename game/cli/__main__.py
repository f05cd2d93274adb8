"""`python -m game.cli` is `gambol`."""

from . import main

main()
