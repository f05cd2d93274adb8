"""The game: one character on a stage, driven by whoever holds the keys or the pad.

`Play` is what a host runs. It needs no window: events in, seconds in, scenes out. Everything
that happens is kept in values (world, camera, pilot), so a moment can be kept and returned to.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np

from controllers.contract import Intent
from controllers.navigation import in_world

from .camera import Follow
from .hosts.events import Event, KeyEvent, MouseMove, PadState, Scroll
from .input import Keyboard, Pilot, Wish, help_sheet, pad_pressed, pad_wish
from .input.bindings import pressed_by
from .scene import Overlays, Scene
from .world import DT, Character, FixedStep, World, figures, ground_between

ORBIT = 4.0
"""How far dragging the mouse over the height of the window turns the camera [rad]."""
ZOOM_PER_NOTCH = 0.88
LONGEST = 0.1
"""The most time that one frame moves the camera [s]."""
SHOWN_SPEED = 0.03
"""Below this speed [m/s] or [rad/s] a character is said to stand."""


def stage(controller: Any) -> World:
    """The world the game opens with."""
    return World((Character("Player", controller, controller.start(ground=(0.0, 0.0, 0.0))),))


class Play:
    """The game as an app: `handle` events, `tick` seconds, draw `scene`, until `done`.

    log: the intents of every step since the last reset; from `opening` they replay the game to
    the bit.
    """

    def __init__(self, controller: Any, world: World | None = None):
        self.opening = stage(controller) if world is None else world
        self.overlays = Overlays(path=True)
        self.done = self.paused = self.helping = False
        self.pad, self.keyboard = None, Keyboard()
        self.reset()

    def reset(self) -> None:
        """Start again from the opening."""
        self.before = self.after = self.opening
        self.log: list[tuple[Intent, ...]] = []
        self.clock, self.pilot = FixedStep(), Pilot()
        self.camera = Follow.behind(self._hero.state.ground)

    @property
    def _hero(self) -> Character:
        return self.after.characters[0]

    def handle(self, event: Event) -> None:
        """Take one event from the host; those that mean nothing here are ignored."""
        match event:
            case KeyEvent(key, True):
                self.keyboard = self.keyboard.press(key)
                for action in pressed_by(key):
                    self.do(action)
            case KeyEvent(key, False):
                self.keyboard = self.keyboard.release(key)
            case MouseMove(dx=dx, dy=dy) if self.keyboard.held("orbit"):
                self.camera = self.camera.turned(-ORBIT * dx, ORBIT * dy)
            case Scroll(dy=notches) if math.isfinite(notches):
                self.camera = self.camera.zoomed(ZOOM_PER_NOTCH ** min(max(notches, -10.0), 10.0))
            case PadState():
                pad = event if event.name else None
                for action in pad_pressed(self.pad, pad):
                    self.do(action)
                self.pad = pad

    def tick(self, seconds: float) -> None:
        """Let `seconds` of real time pass: whole steps, then the camera."""
        running = not (self.paused or self.helping)
        seconds = seconds if 0.0 <= seconds < math.inf else 0.0
        wish = self._wish()
        if running:
            steps, self.clock = self.clock.add(seconds)
            for _ in range(steps):
                self._step(wish)
        # the camera keeps to the display's frames, also while the world stands still
        frame = min(seconds, LONGEST)
        if wish.orbit != (0.0, 0.0):
            rate = self.pilot.pace.orbit * frame
            self.camera = self.camera.turned(rate * wish.orbit[0], rate * wish.orbit[1])
        state = self._hero.state
        velocity = in_world(state.ground, state.velocity) if running else np.zeros(2)
        ground = ground_between(self.before.characters[0].state, state, self.clock.alpha)
        self.camera = self.camera.step(ground, velocity, Wish(), frame, self.after.props)

    def _wish(self) -> Wish:
        return self.keyboard.wish().merged(pad_wish(self.pad))

    def _step(self, wish: Wish) -> None:
        state = self._hero.state
        self.pilot, command = self.pilot.command(wish, self.camera.yaw, float(state.ground[2]), DT)
        if command.swing:
            self.camera = self.camera.turned(command.swing * DT)
        intents = (command.intent(state),) + (Intent(),) * (len(self.after.characters) - 1)
        self.before, self.after = self.after, self.after.step(intents)
        self.log.append(intents)

    def scene(self, size: tuple[int, int]) -> Scene:
        """What to draw now; size: of the frame in pixels."""
        return Scene(self.camera.view(), figures(self.before, self.after, self.clock.alpha), self.after.props,
                     self.overlays, self._text(), self._panel())

    def _text(self) -> tuple[str, ...]:
        v_f, omega, v_l = self._hero.state.velocity
        if math.hypot(v_f, v_l) < SHOWN_SPEED and abs(omega) < SHOWN_SPEED:
            moving = "standing"
        else:
            moving = f"{math.hypot(v_f, v_l):.1f} m/s" + (f"   turning {omega:+.1f} rad/s" if abs(omega) > 0.2 else "")
        return (moving + ("   facing held" if self.pilot.facing is not None else ""), "F1 help")

    def _panel(self) -> tuple[str, ...]:
        if self.helping:
            return ("Controls", *help_sheet())
        return ("Paused", "P goes on, . makes one step") if self.paused else ()

    def do(self, action: str) -> None:
        """Do what pressing the key or button of an action does."""
        if action in ("mesh", "skeleton", "contacts", "trail", "path"):
            self.overlays = replace(self.overlays, **{action: not getattr(self.overlays, action)})
        elif action == "pause":
            self.paused = not self.paused
        elif action == "help":
            self.helping = not self.helping
        elif action == "reset":
            self.reset()
        elif action == "step" and self.paused:
            self._step(self._wish())
            self.clock = replace(self.clock, owed=DT)
        elif action == "strafe_lock":
            self.pilot = self.pilot.toggled()
        elif action == "recentre":
            self.camera = self.camera.recentred(float(self._hero.state.ground[2]))
        elif action == "quit":
            self.done, self.helping = not self.helping, False
