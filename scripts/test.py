"""Set Gambol up with what its tests need, if need be, and run them.

    python3 scripts/test.py [arguments of pytest]
"""

import sys

import _setup


def main() -> int:
    _setup.ready("test")
    return _setup.run("-m", "pytest", *sys.argv[1:], folder=_setup.ROOT)


if __name__ == "__main__":
    sys.exit(main())
