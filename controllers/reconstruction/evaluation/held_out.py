"""What the network that ships was learnt from, and what it never was: so that everybody measures it on the rest."""

from __future__ import annotations

from pathlib import Path

from ..database import Database, DatabaseError, Take, actions
from .trials import long_takes, split, split_actions, without

CMU = ("cmu/", "cmu_bvh/", "cmu_30fps/")
"""Folders whose motion may be learnt from for a network that ships."""
STRANGERS = ("10", "12", "26", "27", "32")
"""Subjects of CMU of whom nothing is learnt."""


def small_of(large: Database, folder: Path) -> Database:
    """The takes of a large database whose clips lie in a folder of motion files. DatabaseError if it lacks some, or was told other actions of
    them: takes are held out by what they show, so others would be tested, some of which what ships was learnt from."""
    clips = {path.relative_to(folder).with_suffix("").as_posix() for path in folder.rglob("*") if path.suffix.lower() in (".bvh", ".amc")}
    small = large.only([take for take in large.takes if take.clip in clips])
    if {take.clip for take in small.takes} != clips:
        raise DatabaseError(f"{large.path}: lacks takes of {folder}; the large database must hold the small one's, too")
    known = {Path(name).with_suffix("").as_posix(): action for name, action in actions(folder).items()}
    for take in small.takes:
        if known.get(take.clip, take.action) != take.action:
            raise DatabaseError(f"{large.path}: {take.clip} is said to show {take.action}, but {known[take.clip]} in {folder / 'index.tsv'}; "
                                "build it from a folder with that index.tsv in it, or other takes are held out")
    return small


def learnt_from(large: Database, small: Database) -> Database:
    """CMU's takes of a large database, less all that is tested on or tuned on in a small one that it holds, and less `STRANGERS`."""
    core = split(small.only([take for take in small.takes if not take.interpolated]))
    apart = split_actions(small, avoid=core.validation)
    rest = without(large, (*core.test, *core.validation, *apart.test, *long_takes(large)))
    return rest.only([take for take in rest.takes if take.clip.startswith(CMU) and take.subject not in STRANGERS])


def strangers(large: Database) -> tuple[Take, ...]:
    """Takes of `STRANGERS`, long enough and sound at their beginning."""
    return tuple(take for take in large.takes if take.clip.startswith(CMU) and take.subject in STRANGERS and not take.mirrored
                 and not take.interpolated and take.stop - take.start >= 90 and bool(large.sound[take.start:min(take.stop, take.start + 631)].all()))


def foreign(large: Database, count: int = 12) -> tuple[Take, ...]:
    """Takes of other data sets than CMU's, evenly spread."""
    found = [take for take in large.takes if not take.clip.startswith(CMU) and not take.mirrored and take.stop - take.start >= 90
             and bool(large.sound[take.start:min(take.stop, take.start + 631)].all())]
    return tuple(found[::max(1, len(found) // count)][:count])
