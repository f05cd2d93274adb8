"""Set Gambol up with what its tests need, if need be, and run them.

    python3 scripts/test.py [--thorough] [arguments of pytest]

Without arguments the tests are run on as many cores as there are, up to eight; with --thorough alone also those that see more widely what a quicker one sees, and all cases
of families of slow ones.
"""

import sys

import _setup

ALL = ("-n", "auto", "--maxprocesses", "8", "--dist", "worksteal")


def main() -> int:
    _setup.ready("test")
    given = sys.argv[1:]
    return _setup.run("-m", "pytest", *([*ALL, *given] if given in ([], ["--thorough"]) else given), folder=_setup.ROOT)


if __name__ == "__main__":
    sys.exit(main())
