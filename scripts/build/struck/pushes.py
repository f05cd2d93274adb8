"""Fits how people answer a push, `assets/library/pushes.npz`, to a folder of motion capture.

    python scripts/build/struck/pushes.py DIR
"""

from __future__ import annotations

import argparse

import numpy as np

from gambol import assets
from gambol.controllers.files import whole
from gambol.controllers.struck import TAKES, fit

if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", help="motion capture, as the fitted takes lie in it")
    folder = parser.parse_args().folder
    response, (behind, before) = fit(folder)
    with whole(assets.path("library", "pushes.npz")) as part, open(part, "wb") as file:
        np.savez_compressed(file, response=response.astype(np.float32), takes=np.array(TAKES))
    print(f"{behind} pushes from behind and {before} from before, of {len(TAKES)} takes")
