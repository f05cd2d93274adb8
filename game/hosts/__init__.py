"""Hosts: who asks for frames. The window shows them as the clock runs; offscreen makes them as asked.

Both draw the same scenes with the same renderer; neither knows what is simulated. Importing this
package opens nothing.
"""

from .events import PADS, App, Event, Focus, KeyEvent, MouseMove, PadState, Resize, Scroll
from .offscreen import GraphicsError, Offscreen, offscreen_context
from .window import DisplayError, run_window

__all__ = [
    "PADS", "App", "DisplayError", "Event", "Focus", "GraphicsError", "KeyEvent", "MouseMove", "Offscreen", "PadState",
    "Resize", "Scroll", "offscreen_context", "run_window",
]
