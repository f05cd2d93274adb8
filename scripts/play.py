"""Set Gambol up, if need be, and play. Without a display, film the demo instead.

    python3 scripts/play.py [options of `gambol play`]
"""

import argparse
import sys

import _setup

NO_DISPLAY = 3  # how `gambol play` ends where no window can be opened
FILM = "out/demo.mp4"
QUICK = ("--fps", "24", "--size", "960x540")  # drawn by the processor alone, and somebody waits for it
SHARED = ("--library", "--preset", "--size")  # what `gambol play` and `gambol render` both know


def main() -> int:
    _setup.ready()
    # -P: nothing in the user's folder is taken for a module of Gambol
    code = _setup.run("-P", "-m", "gambol.game.cli", "play", *sys.argv[1:])
    if code != NO_DISPLAY:
        return code
    options, others = for_film(sys.argv[1:])
    print(f"There is no display here, so the demo is filmed into {FILM}"
          + (f" (where {' '.join(others)} means nothing)" if others else "") + ": four minutes or so", flush=True)
    code = _setup.run("-P", "-m", "gambol.game.cli", "render", "demo", "-o", FILM, *QUICK, *options)
    if code == 0:
        print(f"Done: copy {FILM} to where you can watch it", flush=True)
    return code


def for_film(arguments: list[str]) -> tuple[list[str], list[str]]:
    """What of a player's options a film can follow, and the rest."""
    parser = argparse.ArgumentParser(add_help=False, allow_abbrev=False)
    for name in SHARED:
        parser.add_argument(name, dest=name)
    known, others = parser.parse_known_args(arguments)
    return [part for name, value in vars(known).items() if value is not None for part in (name, value)], others


if __name__ == "__main__":
    sys.exit(main())
