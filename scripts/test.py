"""Set Gambol up with what its tests need, if need be, and run them.

    python3 scripts/test.py [--thorough] [arguments of pytest]

All of them, with any options that begin with "-", are run on as many cores as there are, up to eight; what names some of them, a path or what follows -k, one after the
other. With --thorough also those that see more widely what a quicker one sees, and all cases of families of slow ones.
"""

import sys

import _setup

ALL = ("-n", "auto", "--maxprocesses", "8", "--dist", "worksteal")


def main() -> int:
    _setup.ready("test")
    given = sys.argv[1:]
    return _setup.run("-m", "pytest", *(ALL if all(one.startswith("-") for one in given) else ()), *given, folder=_setup.ROOT)


if __name__ == "__main__":
    sys.exit(main())
