"""What scripts that draw share: whether pictures can be drawn, told before anything is measured, and how they look."""

from __future__ import annotations

import argparse
from pathlib import Path


def pictures(parser: argparse.ArgumentParser, folder: Path | None) -> None:
    """Make the folder for pictures, if any are wanted; a parser's error where they can't be drawn or kept."""
    if folder is None:
        return
    try:
        import matplotlib  # noqa: F401
        folder.mkdir(parents=True, exist_ok=True)
    except ImportError:
        parser.error('--plots needs matplotlib: .venv/bin/pip install -e ".[report]"')
    except OSError as error:
        parser.error(f"--plots: {error}")


def pyplot():
    """Matplotlib's pyplot, without a window and without frames around what is shown."""
    import matplotlib
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    plt.rcParams.update({"figure.dpi": 110, "font.size": 9, "axes.grid": True, "grid.alpha": 0.3, "axes.spines.top": False,
                         "axes.spines.right": False, "legend.frameon": False, "savefig.bbox": "tight"})
    return plt
