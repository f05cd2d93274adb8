"""Values that say in a line or two what they are, where a dataclass would print every number of its arrays."""

from __future__ import annotations

from dataclasses import fields, is_dataclass
from typing import Any

import numpy as np

SMALL = 4
"""Arrays of no more numbers than this are printed; of others the type and the shape."""
DEEP = 2
"""So deep values are told that lie in others; of what lies deeper, the name."""
LONG = 120
"""What would take more letters is told by its name."""


def brief(self: Any) -> str:
    """What a dataclass prints as: put `__repr__ = brief` into it."""
    return _told(self, DEEP)


def _told(self: Any, deep: int) -> str:
    return f"{type(self).__name__}({', '.join(f'{one.name}={_said(getattr(self, one.name), deep)}' for one in fields(self) if one.repr)})"


def _said(value: Any, deep: int) -> str:
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
    if isinstance(value, tuple | list) and any(not isinstance(one, str | int | float) for one in value):
        said = f"{'[' if isinstance(value, list) else '('}{', '.join(_said(one, deep) for one in value)}{',' * (isinstance(value, tuple) and len(value) == 1)}"
        return said + ("]" if isinstance(value, list) else ")")
    if isinstance(value, dict) and value:
        return f"<{len(value)} by name>"
    if is_dataclass(value) and not isinstance(value, type):
        return _told(value, deep - 1) if deep and (type(value).__repr__ is brief or not _wide(value)) else f"<{type(value).__name__}>"
    said = repr(value)
    return said if isinstance(value, str) or len(said) <= LONG else f"<{type(value).__name__}>"


def _wide(value: Any) -> bool:
    """Whether a value within another has too many fields to be told there, or large arrays."""
    return len(fields(value)) > 3 * SMALL or any(isinstance(one, np.ndarray) and one.size > SMALL for one in (getattr(value, field.name) for field in fields(value)))
