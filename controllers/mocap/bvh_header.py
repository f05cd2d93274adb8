"""The header of a BVH file: its joints, its channels and how many frames to expect."""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from typing import NoReturn

import numpy as np

from .parsing import decode, fail, number, numbers, whole

CHANNELS = {f"{axis}{kind}": (kind, i) for kind in ("rotation", "position") for i, axis in enumerate("xyz")}
LONGEST = 2.0
"""The longest time between two frames [s]: what is farther apart is no motion, and would be filled with millions of frames."""
_LAST_LINE = re.compile(rb"^[ \t]*frame[ \t]+time\b[^\n]*\n?", re.IGNORECASE | re.MULTILINE)
_COLON = re.compile(r"^(\s*(?:frames|frame\s+time)\s*:)", re.IGNORECASE | re.MULTILINE)


@dataclass
class Joint:
    """One ROOT or JOINT. channels: pairs such as ("rotation", 2) for Zrotation, as the file orders them.
    offset: (3,), not a number until it is read."""

    name: str
    parent: int
    line: int
    offset: np.ndarray = field(default_factory=lambda: np.full(3, np.nan))
    channels: list[tuple[str, int]] = field(default_factory=list)
    ends: list[np.ndarray] = field(default_factory=list)


class _Words:
    """The header word by word, and the line of the word taken last."""

    def __init__(self, text: str, path):
        text = _COLON.sub(r"\1 ", text.replace("{", " { ").replace("}", " } "))
        self._words = [(word, i) for i, line in enumerate(text.split("\n"), 1) for word in line.split()]
        self._at, self.line, self.path = 0, 1, path

    def peek(self) -> str:
        """The next word, "" behind the last."""
        return self._words[self._at][0] if self._at < len(self._words) else ""

    def take(self) -> str:
        """The next word, "" behind the last."""
        if self._at == len(self._words):
            return ""
        word, self.line = self._words[self._at]
        self._at += 1
        return word

    def expect(self, *expected: str) -> None:
        """Take the words that must come now, in any case."""
        for want in expected:
            if (word := self.take()).upper() != want.upper():
                self.fail(f"{_quote(word)} where '{' '.join(expected)}' should stand")

    def fail(self, problem: str) -> NoReturn:
        fail(self.path, self.line, problem)


def read_header(data: bytes, path) -> tuple[list[Joint], int, float, int]:
    """Joints in file order, the frames claimed, the frame time [s], the byte where the frames begin."""
    last = _LAST_LINE.search(data)
    body = last.end() if last else len(data)
    words = _Words(decode(data[:body], path), path)
    words.expect("HIERARCHY")
    joints = _joints(words)
    words.expect("Frames:" if words.peek().endswith(":") else "Frames")
    frames = whole(words.take().lstrip(":"), "the number of Frames", path, words.line)
    if frames == 0:
        words.fail("the file holds zero frames; at least one is needed")
    words.expect("Frame")
    words.expect("Time:" if words.peek().endswith(":") else "Time")
    frame_time = number(words.take().lstrip(":"), path, words.line)
    if not 0.0 < frame_time <= LONGEST:
        rate = f"; {frame_time:g} frames a second would be {1 / frame_time:.6g}" if 0.0 < frame_time < 1000.0 else ""
        words.fail(f"the Frame Time must be above zero and at most {LONGEST:g} seconds, not {frame_time:g}{rate}")
    if words.peek():
        words.fail(f"{_quote(words.take())} after the Frame Time: the frames begin on the next line")
    return joints, frames, frame_time, body


def _joints(words: _Words) -> list[Joint]:
    """Everything from ROOT to MOTION."""
    joints: list[Joint] = []
    lines: dict[str, int] = {}
    nest: list[int] = []  # the joints whose brace is open; -1 for an end site
    while True:
        word, line = words.take(), words.line
        key = word.upper()
        here = joints[nest[-1]] if nest and nest[-1] >= 0 else None
        if key == "ROOT" and not joints or key == "JOINT" and here:
            name = _name(words, word)
            if name in lines:
                fail(words.path, line, f"joint '{name}' was already declared in line {lines[name]}")
            lines[name] = line
            joints.append(Joint(name, nest[-1] if nest else -1, line))
            nest.append(len(joints) - 1)
        elif key == "END" and here:
            _name(words, word)
            nest.append(-1)
        elif key == "OFFSET" and here:
            here.offset = _offset(words, f"'{here.name}'")
        elif key == "OFFSET" and nest:
            owner = joints[nest[-2]]
            owner.ends.append(_offset(words, f"the End Site of '{owner.name}'"))
        elif key == "CHANNELS" and here:
            here.channels = _channels(words, here)
        elif word == "}" and nest:
            if here and np.isnan(here.offset).any():
                words.fail(f"joint '{here.name}' of line {here.line} has no OFFSET")
            nest.pop()
        elif key == "MOTION" and joints and not nest:
            return joints
        else:
            _misplaced(words, word, joints, nest)


def _misplaced(words: _Words, word: str, joints: list[Joint], nest: list[int]) -> NoReturn:
    if word.upper() == "ROOT":
        words.fail("a second ROOT: a file holds one skeleton")
    if word.lower() in CHANNELS:
        words.fail(f"{_quote(word)} is one channel more than CHANNELS declares")
    if nest:
        owner = joints[nest[-1] if nest[-1] >= 0 else nest[-2]]
        words.fail(f"{_quote(word)} where JOINT, End Site, OFFSET, CHANNELS or '}}' should stand: "
                   f"'{owner.name}' of line {owner.line} is still open")
    words.fail(f"{_quote(word)} where {'MOTION' if joints else 'ROOT'} should stand")


def _name(words: _Words, kind: str) -> str:
    """The words up to the opening brace, which is taken too."""
    name = []
    line = words.line
    while words.peek() not in ("{", "}", "") and words.peek().upper() not in ("OFFSET", "CHANNELS"):
        name.append(words.take())
    if words.peek() != "{":
        fail(words.path, line, f"no '{{' after {kind} {' '.join(name)[:40]}".rstrip())
    words.take()
    if not name:
        fail(words.path, line, f"{kind} needs a name")
    return " ".join(name)


def _offset(words: _Words, what: str) -> np.ndarray:
    found = []
    while len(found) < 3 and not words.peek()[:1].isalpha() and words.peek() not in ("{", "}", ""):
        found.append(words.take())
    return numbers(found, 3, f"the OFFSET of {what}", words.path, words.line)


def _channels(words: _Words, joint: Joint) -> list[tuple[str, int]]:
    count = whole(words.take(), "the number of CHANNELS", words.path, words.line)
    channels: list[tuple[str, int]] = []
    while len(channels) < count:
        word = words.peek()
        if word.upper() in ("JOINT", "END", "OFFSET", "MOTION", "{", "}", ""):
            words.fail(f"'{joint.name}' declares {count} CHANNELS but names {len(channels)}")
        words.take()
        if word.lower() not in CHANNELS:
            words.fail(f"unknown channel {_quote(word)}: a channel is X, Y or Z with position or rotation")
        channels.append(CHANNELS[word.lower()])
    for axis in range(3):
        if channels.count(("position", axis)) > 1:
            words.fail(f"'{joint.name}' has {'XYZ'[axis]}position twice")
    return channels


def _quote(word: str) -> str:
    return f"'{word[:40]}'" if word else "the end of the header"
