"""Pictures without a display, through EGL."""

from __future__ import annotations

import ctypes.util
import os
import sys
from collections.abc import Sequence
from typing import Any

import numpy as np

from ..render import Preset, Renderer
from ..scene import Scene


class GraphicsError(RuntimeError):
    """OpenGL can't be had here; the message says what to do."""


def offscreen_context() -> Any:
    """An OpenGL 3.3 core context with no window. GraphicsError says which library is missing."""
    import moderngl

    if not sys.platform.startswith("linux"):  # macOS and Windows make hidden contexts themselves
        try:
            return moderngl.create_standalone_context(require=330)
        except Exception as error:
            raise GraphicsError(f"OpenGL 3.3 can't be had: {error}. Update the graphics driver.") from error
    # the display server plays no part, and a stale DISPLAY must not matter
    hint = _missing()
    try:
        names = {key: f"lib{name}.so.{n}" for key, name, n in (("libgl", "GL", 1), ("libegl", "EGL", 1))}
        settings: dict[str, Any] = {"backend": "egl", **names}
        return moderngl.create_context(require=330, standalone=True, **settings)
    except Exception as error:
        raise GraphicsError(hint or f"EGL gives no OpenGL 3.3 here: {error}. "
                            "Mesa's software renderer would do: sudo apt install libgl1-mesa-dri") from error


def _missing() -> str:
    """What to install, if a library of the loader is missing; else nothing."""
    wanted = (("EGL", "libegl1"), ("GL", "libgl1"))
    lacking = [(name, package) for name, package in wanted if ctypes.util.find_library(name) is None]
    if not lacking:
        return ""
    libraries = " and ".join(f"lib{name}.so.1" for name, _ in lacking)
    packages = " ".join(package for _, package in lacking)
    sudo = "" if getattr(os, "geteuid", lambda: 1)() == 0 else "sudo "
    return (f"drawing without a display needs {libraries}, which {'are' if len(lacking) > 1 else 'is'} "
            f"not installed. Type: {sudo}apt install {packages} libgl1-mesa-dri")


class Offscreen:
    """A renderer with its own context. Use in a `with`, or call `release`.

    size: width, height in pixels. chosen: a preset or its name.
    """

    def __init__(self, size: tuple[int, int] = (1280, 720), chosen: str | Preset = "full"):
        self.context = offscreen_context()
        try:
            self.renderer = Renderer(self.context, size, chosen)
        except BaseException:
            self.context.release()
            raise

    def frame(self, scenes: Scene | Sequence[Scene], out: np.ndarray | None = None) -> np.ndarray:
        """The picture of a scene, or of several side by side, (H, W, 4) uint8, top row first; into `out` where given."""
        self._make_current()
        self.renderer.draw(scenes)
        return self.renderer.read(out)

    def resize(self, size: tuple[int, int]) -> None:
        """Draw pictures of another size, width and height in pixels, from now on."""
        self._make_current()
        self.renderer.resize(size)

    def release(self) -> None:
        """Give the graphics card back."""
        self._make_current()
        self.renderer.release()
        self.context.release()

    def _make_current(self) -> None:
        """Other contexts may have been made since; a `with` would leave none current."""
        self.context.__enter__()

    def __enter__(self) -> Offscreen:
        return self

    def __exit__(self, *error) -> None:
        self.release()
