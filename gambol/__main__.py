"""`python -m gambol` is `gambol`."""

from gambol.game.cli import main

if __name__ == "__main__":
    main()
