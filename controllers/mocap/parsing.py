"""Text to numbers, fast, with errors that name the file and the line.

Motion files are megabytes of decimal numbers; the kernels here read them straight from bytes.
Nothing is allocated by what a header claims, only by what the file really holds.
"""

from __future__ import annotations

from typing import NoReturn

import numpy as np

from ..compiled import kernel
from ..files import contents, reason

_TENS = 10.0 ** np.arange(23)  # exactly representable: one division or product rounds only once
LIMIT = 1e15
"""Numbers beyond this are taken for damage, like nan and inf: no unit makes them a place or an angle."""
_OK, _BAD_COUNT, _BAD_NUMBER, _TOO_MANY = range(4)


class MotionFileError(ValueError):
    """A motion file that can't be read; the message names file, line and what would be right."""


def fail(path, line: int | None, problem: str) -> NoReturn:
    """Raise the MotionFileError for `line` (1-based; None for the file as a whole)."""
    where = f"{path}" if line is None else f"{path}, line {line}"
    raise MotionFileError(f"{where}: {problem}")


def read_bytes(path) -> bytes:
    """A file's bytes with \\n at least between lines and no byte-order mark; never empty."""
    try:
        data = contents(path)
    except FileNotFoundError:
        fail(path, None, "there is no such file")
    except IsADirectoryError:
        fail(path, None, "this is a directory: name one file in it")
    except (OSError, ValueError) as error:  # ValueError: a NUL in the name
        fail(path, None, f"can't be opened: {reason(error)}")
    data = data.removeprefix(b"\xef\xbb\xbf")
    if not data.strip():
        fail(path, 1, "the file is empty")
    return data if b"\n" in data else data.replace(b"\r", b"\n")


def decode(data: bytes, path) -> str:
    """UTF-8 text of `data`, which begins the file."""
    try:
        return data.decode("utf-8")
    except UnicodeDecodeError as error:
        fail(path, line_at(data, error.start), f"byte 0x{data[error.start]:02x} is not UTF-8 text; "
             "save the file as plain text (UTF-8)")


def line_at(data: bytes, position: int) -> int:
    """The 1-based line of a byte."""
    return data.count(b"\n", 0, position) + 1


def number(word: str, path, line: int) -> float:
    """One finite number from a header."""
    try:
        value = float(word)
    except ValueError:
        value = np.nan
    if not abs(value) <= LIMIT:
        fail(path, line, f"'{word[:40]}' is not a finite number")
    return value


def numbers(words: list[str], count: int, what: str, path, line: int) -> np.ndarray:
    """Exactly `count` finite numbers (count,)."""
    if len(words) != count:
        fail(path, line, f"{what} needs {count} numbers, found {len(words)}")
    return np.array([number(word, path, line) for word in words])


def whole(word: str, what: str, path, line: int) -> int:
    """A whole number ≥ 0."""
    if not (word.isascii() and word.isdigit() and len(word) < 19):
        fail(path, line, f"{what} must be a whole number, not '{word[:40]}'")
    return int(word)


def token_at(data: bytes, position: int) -> str:
    """The word that starts at a byte, for an error message."""
    return (data[position:position + 40].split() or [b""])[0].decode("utf-8", "replace")


def table(data: bytes, start: int, columns: int, claimed: int, path) -> np.ndarray:
    """The `claimed` rows of `columns` numbers (claimed, columns), one row a line, from byte `start`.

    Blank lines are skipped. MotionFileError for a row of another length, a word that is no finite
    number, fewer rows than claimed, or more.
    """
    room = (len(data) - start) // (2 * columns) + 1  # a number takes two bytes at least
    out = np.empty((min(claimed, room), columns))
    rows, code, position, count = _rows(np.frombuffer(data, np.uint8), start, out)
    line = line_at(data, position)
    if code == _BAD_NUMBER:
        fail(path, line, f"value {count + 1} of {columns} is '{token_at(data, position)}', "
             "not a finite number")
    if code == _BAD_COUNT:
        cut = "" if data.find(b"\n", position) >= 0 else "; the file ends here: was it truncated?"
        fail(path, line, f"{count} values, but the header declares {columns} channels{cut}")
    if code == _TOO_MANY and rows == claimed:
        fail(path, line, f"more frames than the {claimed} that the header declares")
    if rows < claimed:
        fail(path, data.rstrip().count(b"\n") + 1, f"the file ends after {rows} frames, "
             f"but the header declares {claimed}: was it truncated?")
    return out


@kernel
def is_space(byte):
    """Space, tab, carriage return and their like, but not a line's end."""
    return byte == 32 or (9 <= byte <= 13 and byte != 10)


@kernel
def parse_number(buffer, i):
    """(value, position behind it, whether it is a number within LIMIT) of the decimal at byte i.

    Up to 15 digits and exponents within ±22 are rounded correctly; the rest to a few 1e-16.
    """
    n = len(buffer)
    negative = buffer[i] == 45
    if negative or buffer[i] == 43:
        i += 1
    mantissa, digits, exponent = 0, 0, 0
    fraction = False
    while i < n:
        byte = buffer[i]
        if 48 <= byte <= 57:
            if mantissa < 100_000_000_000_000_000:
                mantissa = mantissa * 10 + (byte - 48)
                exponent -= fraction
            else:  # further digits are below double precision
                exponent += not fraction
            digits += 1
        elif byte == 46 and not fraction:
            fraction = True
        else:
            break
        i += 1
    if digits == 0:
        return 0.0, i, False
    if i < n and (buffer[i] == 101 or buffer[i] == 69):
        i += 1
        down = i < n and buffer[i] == 45
        if i < n and (down or buffer[i] == 43):
            i += 1
        power, digits = 0, 0
        while i < n and 48 <= buffer[i] <= 57:
            power = min(power * 10 + (buffer[i] - 48), 100_000)
            digits += 1
            i += 1
        if digits == 0:
            return 0.0, i, False
        exponent += -power if down else power
    value = float(mantissa)
    if -22 <= exponent < 0:
        value /= _TENS[-exponent]
    elif 0 < exponent <= 22:
        value *= _TENS[exponent]
    elif exponent < 0:
        value = value / 1e22 * 10.0 ** (exponent + 22)
    elif exponent > 0 and mantissa > 0:
        value *= 10.0 ** exponent
    ended = i == n or is_space(buffer[i]) or buffer[i] == 10
    return (-value if negative else value), i, ended and value <= LIMIT


@kernel
def _rows(buffer, i, out):
    """Fill `out`; return (rows, code, the byte that the code speaks of, values read in its row)."""
    n, columns = len(buffer), out.shape[1]
    row = 0
    while True:
        while i < n and (is_space(buffer[i]) or buffer[i] == 10):
            i += 1
        if i == n:
            return row, _OK, i, 0
        first, count = i, 0
        if row == len(out):
            return row, _TOO_MANY, first, 0
        while i < n and buffer[i] != 10:
            value, behind, good = parse_number(buffer, i)
            if not good:
                return row, _BAD_NUMBER, i, count
            if count < columns:
                out[row, count] = value
            count += 1
            i = behind
            while i < n and is_space(buffer[i]):
                i += 1
        if count != columns:
            return row, _BAD_COUNT, first, count
        row += 1


@kernel
def turns(table, columns, joints, axes, joint_count):
    """Local rotations (T, J, 4), quaternions x, y, z, w, from angles in a table of numbers.

    Each channel k turns joint joints[k] by table[:, columns[k]] [rad] about the fixed axis axes[k]
    (3,), one after another as intrinsic rotations: q ← q · turn.
    """
    out = np.zeros((len(table), joint_count, 4))
    out[:, :, 3] = 1.0
    for t in range(len(table)):
        for k in range(len(columns)):
            half = 0.5 * table[t, columns[k]]
            sine, w = np.sin(half), np.cos(half)
            x, y, z = axes[k, 0] * sine, axes[k, 1] * sine, axes[k, 2] * sine
            q = out[t, joints[k]]
            a, b, c, d = q[0], q[1], q[2], q[3]
            q[0] = d * x + a * w + b * z - c * y
            q[1] = d * y - a * z + b * w + c * x
            q[2] = d * z + a * y - b * x + c * w
            q[3] = d * w - a * x - b * y - c * z
    return out
