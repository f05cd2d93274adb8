"""`python -m gambol.game.cli` is `gambol`."""

from . import main

main()
