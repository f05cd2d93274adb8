"""What goes wrong between a lens and a disk: noise, things in the way, light that changes, frames corrupted or dropped. Seeded:
a camera's frame is disturbed the same way whenever and in whatever order it is made."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import numpy as np
from pydantic import BaseModel, ConfigDict, Field, ValidationError

from ..files import did_you_mean, toml
from ..footage import FootageError

Share = Annotated[float, Field(ge=0.0, le=1.0, allow_inf_nan=False)]


class Sensor(BaseModel):
    """A `[sensor]` table. noise: standard deviation of grey levels over their range. replaced: share of pixels that have any
    colour instead of their own; the paper's 15 % of uncorrelated noise. rectangles: of any size and colour in each frame.
    light: how far the light swells and fades, and within how many seconds `period`. corrupted: share of frames that hold
    something else. dropped: share that are missing. seed: another one, another disturbance."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    noise: Share = 0.0
    replaced: Share = 0.0
    rectangles: Annotated[int, Field(ge=0, le=1000)] = 0
    light: Share = 0.0
    period: Annotated[float, Field(gt=0.0, le=3600.0, allow_inf_nan=False)] = 4.0
    corrupted: Share = 0.0
    dropped: Share = 0.0
    seed: Annotated[int, Field(ge=0, lt=2**32)] = 0

    def fate(self, camera: int, frame: int) -> str:
        """What becomes of a camera's frame: "dropped", "corrupted" or "kept". The first two frames are always kept."""
        chance = self._random(camera, frame, 0).random(2)
        if frame < 2:
            return "kept"
        return "dropped" if chance[0] < self.dropped else "corrupted" if chance[1] < self.corrupted else "kept"

    def disturbed(self, picture: np.ndarray, camera: int, frame: int, time: float) -> np.ndarray:
        """A camera's picture (H, W, 3) uint8 at a time [s], as it is stored."""
        rng = self._random(camera, frame, 1)
        if self.fate(camera, frame) == "corrupted":
            return rng.integers(0, 256, picture.shape, np.uint8) if rng.random() < 0.5 else np.roll(
                picture[::-1, ::-1], rng.integers(1, min(picture.shape[:2]), 2), (0, 1)).copy()
        height, width = picture.shape[:2]
        out = picture.astype(np.float32)
        if self.light:
            out *= 1.0 + self.light * np.float32(np.sin(2 * np.pi * (time / self.period + rng.random() * 0.02 + 0.37 * camera)))
        for _ in range(self.rectangles):
            w, h = rng.integers(max(width // 40, 1), max(width // 6, 2), 2)
            x, y = rng.integers(0, width), rng.integers(0, height)
            out[y:y + h, x:x + w] = rng.integers(0, 256, 3)
        if self.noise:
            out += rng.standard_normal(out.shape, np.float32) * np.float32(255.0 * self.noise)
        if self.replaced:
            which = rng.random((height, width), np.float32) < self.replaced
            out[which] = rng.integers(0, 256, (int(which.sum()), 3))
        return np.clip(out + 0.5, 0, 255).astype(np.uint8)

    def _random(self, camera: int, frame: int, kind: int) -> np.random.Generator:
        return np.random.default_rng((self.seed, camera, frame, kind))


def read_sensor(path: str | Path) -> Sensor:
    """The `[sensor]` table of a file of cameras; a perfect one where there is none. FootageError, naming the field."""
    path = Path(path)
    if path.suffix.lower() != ".toml":
        return Sensor()
    table = toml.read(path, FootageError).get("sensor", {})
    try:
        return Sensor.model_validate(table)
    except ValidationError as error:
        fault = error.errors()[0]
        field = ".".join(map(str, fault["loc"]))
        if fault["type"] == "extra_forbidden":
            raise FootageError(f"{path}: sensor.{field}: there is no such field{did_you_mean(field, Sensor.model_fields)}") from None
        raise FootageError(f"{path}: sensor{'.' if field else ''}{field}: {fault['msg']}, not {fault['input']!r:.60}") from None
