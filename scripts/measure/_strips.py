"""The worst moments as strips of stick figures."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from _plots import pyplot

def draw(worst, folder: Path, name: str, unit: str = "×") -> None:
    """The ten worst moments as strips of stick figures, from the side. unit: of the figures, by which a joint's name stands if
    they are a joint's."""
    plt = pyplot()
    figure, axes = plt.subplots(len(worst), 1, figsize=(15, 2.1 * len(worst)))
    for axis, (value, label, motion, n, t) in zip(np.atleast_1d(axes), worst):
        positions, parents = motion.kinematics[0][:, n], motion.skeleton.parents
        for k, frame in enumerate(range(t - 10, t + 11, 2)):
            if not 0 <= frame < len(positions):
                continue
            p = positions[frame]
            heading = motion.com_velocity[min(max(t, 0), len(positions) - 1), n][[0, 2]]
            way = heading / (np.linalg.norm(heading) + 1e-9)
            along = (p[:, [0, 2]] - positions[t, 0, [0, 2]]) @ way + 0.9 * k
            for j in range(1, len(parents)):
                i = parents[j]
                side = motion.skeleton.names[j]
                colour = "tab:red" if side.startswith("Left") else "tab:blue" if side.startswith("Right") else "k"
                axis.plot(along[[i, j]], p[[i, j], 1], color=colour, lw=1.2)
            axis.text(0.9 * k, -0.1, f"{(frame - t) / motion.rate:+.2f}", fontsize=6)
        axis.set_aspect("equal")
        axis.axhline(0, color="0.7", lw=0.5)
        joint = f" {motion.skeleton.names[int(motion.joints[t, n].argmax())]}" if unit == "×" else ""
        axis.set_title(f"{label}:{joint} {value:.1f}{unit}", fontsize=8)
        axis.axis("off")
    figure.savefig(folder / f"{name}.png")
    plt.close(figure)
