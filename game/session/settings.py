"""What can be tuned while playing: names, bounds, and how a value gets to where it counts.

A setting is called after its owner: "locomotion.acceleration", "pace.walk", "camera.fov". As an
action it is written "name=value"; so sliders, files and logs all say the same.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Any


class SettingError(ValueError):
    """A setting that there is not, or a value that it can't take."""


@dataclass(frozen=True)
class Setting:
    """One number to tune. low, high: its bounds; whole: only whole numbers; a switch is 0 or 1."""

    name: str
    low: float
    high: float
    unit: str = ""
    whole: bool = False

    def read(self, text: str) -> float | int:
        """A value within the bounds from its text. SettingError unless it is a finite number."""
        try:
            value = float(text)
        except ValueError:
            value = math.nan
        if not math.isfinite(value):
            raise SettingError(f"{self.name}={text}: needs a number from {self.low:g} to {self.high:g}")
        value = min(max(value, self.low), self.high)
        return round(value) if self.whole else value


SETTINGS = (
    Setting("locomotion.agility", 0.4, 3.0),
    Setting("locomotion.command_halflife", 0.02, 0.6, "s"),
    Setting("locomotion.acceleration", 1.0, 12.0, "m/s²"),
    Setting("locomotion.weight_halflife", 0.01, 0.4, "s"),
    Setting("locomotion.switch_halflife", 0.02, 0.5, "s"),
    # the two speeds can't cross, or a walker would dither between gaits
    Setting("locomotion.run_above", 1.75, 3.0, "m/s"),
    Setting("locomotion.walk_below", 1.0, 1.75, "m/s"),
    Setting("locomotion.correct", 0, 5, whole=True),
    Setting("locomotion.footing", 0, 1, whole=True),
    Setting("locomotion.clearance", 0.0, 0.08, "m"),
    Setting("locomotion.breath", 0.0, 0.05, "rad"),
    Setting("locomotion.idle", 0.0, 1.5),
    Setting("locomotion.gaze", 0.0, 1.0),
    Setting("steering.gain", 1.0, 10.0, "1/s"),
    Setting("steering.turn", 0.5, 4.0, "rad/s"),
    Setting("steering.fade", 0.02, 0.5, "m/s"),
    Setting("steering.commit", 0.0, 1.5, "rad"),
    Setting("pace.slow", 0.2, 1.2, "m/s"),
    Setting("pace.walk", 0.6, 1.8, "m/s"),
    Setting("pace.run", 1.9, 4.5, "m/s"),
    Setting("pace.turn", 0.3, 3.0, "rad/s"),
    Setting("camera.height", 0.3, 1.8, "m"),
    Setting("camera.fov", 0.3, 1.6, "rad"),
    Setting("camera.ahead", 0.0, 1.0, "s"),
    Setting("camera.turn", 0.5, 6.0, "rad/s"),
    Setting("camera.focus_halflife", 0.0, 0.6, "s"),
    Setting("camera.orbit_halflife", 0.0, 0.4, "s"),
    Setting("camera.arm_halflife", 0.0, 1.0, "s"),
    Setting("camera.swing", 0.2, 10.0, "s"),
    Setting("camera.rest", 0.0, 10.0, "s"),
)
"""Every setting, in the order to show them."""

_BY_NAME = {setting.name: setting for setting in SETTINGS}


def read(action: str) -> tuple[Setting, float | int]:
    """The setting and the value that "name=value" speaks of. SettingError says what is wrong."""
    name, _, text = action.partition("=")
    if name not in _BY_NAME:
        raise SettingError(f"{action}: there is no setting {name!r}; there are {', '.join(_BY_NAME)}")
    return _BY_NAME[name], _BY_NAME[name].read(text)


def value(owners: dict[str, Any], name: str) -> float | None:
    """What a setting stands at; None where its owner has no such thing. owners: see `changed`."""
    owner, _, field = name.partition(".")
    return getattr(owners.get(owner), field, None)


def changed(owners: dict[str, Any], action: str) -> tuple[str, Any]:
    """The name of the owner that "name=value" changes, and the owner as it is then.

    owners: settings by owner, frozen dataclasses or named tuples. One that lacks the setting (a
    controller of another kind) stays as it is.
    """
    setting, number = read(action)
    owner, _, field = setting.name.partition(".")
    old = owners.get(owner)
    if old is None or not hasattr(old, field):
        return owner, old
    number = type(getattr(old, field))(number)
    return owner, old._replace(**{field: number}) if hasattr(old, "_replace") else replace(old, **{field: number})
