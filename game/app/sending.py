"""A body sent on as it moves, by the VMC protocol, so that Unity, Unreal, Blender, VSeeFace and others show whoever is played."""

from __future__ import annotations

from typing import Any

from ..world import Character, World


def sure(state: Any) -> float:
    """How sure a body is of its pose, 0 … 1: the share of the points that are followed; 0 while it follows nothing."""
    from gambol.controllers.reconstruction import Following

    following = state.memory.memory
    return float(following.gate.trusted.mean()) if isinstance(following, Following) else 0.0


def shown(world: World) -> Character:
    """Who is sent of a world: the first who is made out of points or of what cameras see; the first of all where nobody is."""
    return next((one for one in world.characters if one.follows is not None or one.watches is not None), world.characters[0])


class Sending:
    """Sends a world's body on, frame by frame. SenderError for an address that is none.

    to: HOST:PORT of each program. lost: how many frames could not be sent.
    """

    def __init__(self, *to: str):
        from gambol.controllers.reconstruction.live import Senders

        self._sender = Senders(to)

    @property
    def lost(self) -> int:
        """How many frames could not be sent."""
        return self._sender.lost

    def send(self, world: World) -> None:
        """Send one frame."""
        one = shown(world)
        self._sender.send(one.controller.skeleton, one.state.pose, one.state.ground, world.time, sure(one.state) if one.follows is not None else 1.0)

    def close(self) -> None:
        """Send no more."""
        self._sender.close()
