"""Values that say in a line or two what they are, where a dataclass would print every number of its arrays."""

from __future__ import annotations

from dataclasses import fields
from typing import Any

import numpy as np

SMALL = 4
"""Arrays of no more numbers than this are printed; of others the type and the shape."""


def brief(self: Any) -> str:
    """What a dataclass prints as: put `__repr__ = brief` into it."""
    return f"{type(self).__name__}({', '.join(f'{one.name}={_said(getattr(self, one.name))}' for one in fields(self) if one.repr)})"


def _said(value: Any) -> str:
    if isinstance(value, np.ndarray):
        if value.size <= SMALL and value.dtype.names is None:
            return np.array2string(value, precision=4, suppress_small=True, separator=", ")
        return f"<{'records' if value.dtype.names else value.dtype} {value.shape}>"
    if isinstance(value, np.void):
        return "<record>"
    if isinstance(value, tuple) and hasattr(value, "_fields"):
        return f"<{type(value).__name__}>"
    if isinstance(value, tuple | list) and len(value) > SMALL:
        return f"<{len(value)} of {value[0]!r}, …>" if isinstance(value[0], str) else f"<{len(value)} of {type(value[0]).__name__}>"
    if isinstance(value, dict) and value:
        return f"<{len(value)} by name>"
    return repr(value)
