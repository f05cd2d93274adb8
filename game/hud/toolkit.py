"""Dear ImGui and ImPlot, imported in one place, and only when somebody first looks at a panel."""

import os

_library = os.environ.get("PYGLFW_LIBRARY")

from imgui_bundle import imgui, implot  # noqa: E402

# the bundle points whoever imports glfw later, children of this process included, to its own copy
if _library is None:
    os.environ.pop("PYGLFW_LIBRARY", None)

__all__ = ["imgui", "implot"]
