"""What a kernel's machine code is made of: its bytecode and options, the constants that it names, and its callees'.

Two kernels of the same ingredients and signature compile to the same code, whatever else changed in their files.
"""

from __future__ import annotations

import dis
import hashlib
import sys
from collections.abc import Iterable
from functools import cache
from types import CodeType, ModuleType
from typing import Any

import numpy as np
from llvmlite import __version__ as LLVMLITE
from numba import __version__ as NUMBA, types
from numba.core.dispatcher import Dispatcher

TOOLS = f"{NUMBA} {LLVMLITE} {np.__version__} {sys.implementation.cache_tag}"
"""What compiles; all that it brings along goes by its name."""
KNOWN = "_heapq", "builtins", "math", "numba", "numpy"
"""Modules of Python and of TOOLS."""


class Untold(Exception):
    """A kernel names something that can't be told by what it holds."""


def ingredients(kernel: Any, signature: Iterable[types.Type]) -> bytes:
    """A checksum (32 bytes) of all that a kernel's code for a signature follows from; Untold where that can't be said.

    What it calls is told once each, in the order in which it is met, so that loops among callees end.
    """
    met, order = {id(kernel): 0}, [kernel]
    told = hashlib.sha256(repr((TOOLS, [_type(one) for one in signature])).encode())
    for one in order:  # grows
        text, callees = _alone(one)
        for callee in callees:
            if id(callee) not in met:
                met[id(callee)] = len(order)
                order.append(callee)
        told.update(f"{text} {[met[id(callee)] for callee in callees]}\n".encode())
    return told.digest()


@cache
def _alone(kernel: Any) -> tuple[str, list[Any]]:
    """A kernel but for what it calls, and what it calls."""
    function, callees = kernel.py_func, []
    codes = [function.__code__]
    for code in codes:  # grows
        codes += [const for const in code.co_consts if isinstance(const, CodeType)]
    steps = [step for code in codes for step in dis.get_instructions(code)]
    attributes = sorted({str(step.argval) for step in steps if step.opname in ("LOAD_ATTR", "LOAD_METHOD")})
    named = {str(step.argval) for step in steps if step.opname in ("LOAD_GLOBAL", "LOAD_NAME")} & function.__globals__.keys()
    values = {name: function.__globals__[name] for name in sorted(named)}
    values |= {f"cell {name}": cell.cell_contents for name, cell in zip(function.__code__.co_freevars, function.__closure__ or ())}
    values |= {"defaults": function.__defaults__, "options": tuple(sorted(kernel.targetoptions.items()))}
    return repr((function.__module__, function.__qualname__, [_code(code, function.__doc__) for code in codes],
                 {name: _value(value, attributes, callees) for name, value in values.items()})), callees


def _code(code: CodeType, doc: str | None) -> Any:
    """Without its comments, its lines and its docstring, which change nothing."""
    consts = [None if isinstance(const, CodeType) or const is doc else _value(const, (), []) for const in code.co_consts]
    return code.co_code, consts, code.co_names, code.co_varnames, code.co_freevars, code.co_cellvars, code.co_argcount


def _value(value: Any, attributes: Iterable[str], callees: list[Any]) -> Any:
    """What a name in a kernel holds. attributes: those that the kernel asks of anything. callees: gets the kernels."""
    if isinstance(value, Dispatcher):
        callees.append(value)
        return "kernel"
    if value is None or value is Ellipsis or isinstance(value, (bool, int, float, complex, str, bytes, np.dtype, types.Type)):
        return type(value).__name__, repr(value)
    if isinstance(value, (np.ndarray, np.generic)):
        if value.dtype.hasobject:
            raise Untold(repr(value))
        return "array", value.dtype.descr, value.shape, value.strides, hashlib.sha256(value.tobytes()).hexdigest()
    if isinstance(value, (set, frozenset)):  # whose order is each process' own
        return "set", sorted(repr(_value(one, attributes, callees)) for one in value)
    if isinstance(value, tuple):
        return _class(type(value)), [_value(one, attributes, callees) for one in value]
    if isinstance(value, ModuleType) and not _known(value.__name__):
        return "module", {name: _value(getattr(value, name), attributes, callees) for name in attributes if hasattr(value, name)}
    if isinstance(value, type):
        return _class(value)
    name = value.__name__ if hasattr(value, "__name__") else ""
    if isinstance(value, (ModuleType, np.ufunc)) or name and _known(getattr(value, "__module__", None) or ""):
        return type(value).__name__, getattr(value, "__module__", ""), name
    raise Untold(repr(value))


def _known(module: str) -> bool:
    return module.partition(".")[0] in KNOWN


def _class(kind: Any) -> Any:
    """A class of others by its name, a named tuple of ours by its fields, too."""
    if fields := getattr(kind, "_fields", None):
        return kind.__module__, kind.__qualname__, fields, _value(tuple(kind._field_defaults.items()), (), [])
    if not _known(kind.__module__):
        raise Untold(repr(kind))
    return kind.__module__, kind.__qualname__


def _type(kind: types.Type) -> Any:
    """A type of an argument, with the fields of all named tuples in it, which its name leaves out."""
    inner = [*getattr(kind, "types", ()), *(part for name in ("type", "dtype") if isinstance(part := getattr(kind, name, None), types.Type))]
    made = getattr(kind, "instance_class", None)
    return repr(kind), made and _class(made), [_type(one) for one in inner]
