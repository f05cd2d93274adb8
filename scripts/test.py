"""Set Gambol up with what its tests need, if need be, and run them.

    python3 scripts/test.py [arguments of pytest]

Without arguments all tests are run, on as many cores as there are, up to eight.
"""

import sys

import _setup

ALL = ("-n", "auto", "--maxprocesses", "8", "--dist", "worksteal")


def main() -> int:
    _setup.ready("test")
    return _setup.run("-m", "pytest", *(sys.argv[1:] or ALL), folder=_setup.ROOT)


if __name__ == "__main__":
    sys.exit(main())
