"""Set Gambol up, if need be, and play. Without a display, film the demo instead.

    python3 scripts/play.py [options of `gambol play`]
"""

import sys

import _setup

NO_DISPLAY = 3  # how `gambol play` ends where no window can be opened
FILM = "out/demo.mp4"


def main() -> int:
    _setup.ready()
    code = _setup.run("-m", "game.cli", "play", *sys.argv[1:])
    if code != NO_DISPLAY:
        return code
    print(f"There is no display here, so the demo is filmed into {FILM}", flush=True)
    code = _setup.run("-m", "game.cli", "render", "demo", "-o", FILM, "--fps", "30")
    if code == 0:
        print(f"Done: copy {FILM} to where you can watch it", flush=True)
    return code


if __name__ == "__main__":
    sys.exit(main())
