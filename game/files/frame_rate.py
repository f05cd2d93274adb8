"""Frame rates as exact fractions: 29.97 is 30000/1001, as every camera and editor means it, and nothing drifts."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

NTSC = Fraction(1001, 1000)
"""So much slower than a whole number of frames a second television has run since it had colours: 23.976, 29.97, 59.94, 119.88."""
NEAR = 0.005
"""Within this of a whole number such a rate is one, however many of its digits are written: 23.98, too."""


def frame_rate(told: Any, most: int = 240) -> Fraction:
    """Frames a second from a number or a text such as "24", "29.97" or "30000/1001". ValueError for what is none from 1 to `most`."""
    try:
        rate = None if isinstance(told, bool) else Fraction(told.replace(" ", "") if isinstance(told, str) else told).limit_denominator(10**6)
    except (ValueError, TypeError, OverflowError, ZeroDivisionError):
        rate = None
    if rate is None or not 1 <= rate <= most:
        raise ValueError(f"needs frames a second from 1 to {most}, such as 30, 29.97 or 30000/1001; got {str(told)[:40]}")
    whole = round(rate * NTSC)
    if rate.denominator > 1 and whole > 1 and abs(rate * NTSC - whole) < NEAR:
        return whole / NTSC
    return rate.limit_denominator(1001)


def plain(rate: Fraction | int) -> int | float:
    """A frame rate as a number for files: whole where it is."""
    return rate.numerator if rate.denominator == 1 else float(rate)
