"""Looking for the leap that somebody asks for from a state: all at once, or a piece in each step, and the nearest place where there is none."""

from __future__ import annotations

import numpy as np

from ...contract import CharacterState, Intent
from ..motion import Plan
from ..reach import MOST, Found, How, Onward, Pieces, Refused, Seeking, too_weak, whole
from .answers import Answers

LEVELS = 0.05
"""Who may land beside a place lands as high or low as it lies, to so much [m]."""
ELSEWHERE = 0.02
"""Whose pelvis is farther than this [m] from where it was as he began to seek, as he still went down into his crouch or came to rest, seeks once more before he is refused."""


class Searches(Answers):
    """Looks for the leaps that are asked of a body."""

    def plan(self, state: CharacterState, intent: Intent) -> Plan:
        """The jump that `intent.leap` asks for, from the state as it is. Refused, with the reason."""
        found = whole(self._looked_for(state, intent))
        if isinstance(found, Found):
            return found.made
        raise Refused(*found)

    def sought(self, state: CharacterState, intent: Intent, onward: Onward | None = None) -> Plan:
        """The same, sought in pieces. onward: of the step before, where the same was asked, or of a place near by. Refused until a plan is found, with why there is none as
        far as that is known. Who rests, or nearly, looks at one plan in each step; who goes on is elsewhere by then, and looks at all of them at once."""
        seeking, steps, began, asked, anew = self._seeks(state, intent) if onward is None or onward.seeking is None else onward
        assert seeking is not None
        steps += 1
        found, onward = seeking.after(steps), Onward(seeking, steps, began, asked, anew)
        if isinstance(found, str):
            raise Refused(found, onward=onward)
        leap = intent.leap
        if not isinstance(found, Found):
            if steps > 1 and not anew and float(np.linalg.norm(state.pose.root - began)) > ELSEWHERE:
                raise Refused("", onward=self._seeks(state, intent)._replace(anew=True))
            raise Refused(*found, onward=Onward(None) if self.placed(state, leap, intent.around)[0].bound else None)  # the next moment may do
        assert leap is not None  # or nothing would have been found
        if steps == 1:
            return found.made
        if isinstance(seeking.after(steps - 1), str):  # it was found just now: no step makes two plans
            raise Refused("", onward=onward)
        start, floor = self.placed(state, leap, intent.around)
        place = found.place if leap.place is None else found.place + (leap.place - asked)  # which may have moved meanwhile
        found = self.again(found.arc.how, start, place, floor, leap.airtime, intent.around)
        made = None if found is None else found.made
        if made is None and not self._rests(state):  # who moves would be elsewhere once more
            made, _ = self.attempt(start, place, floor, leap.airtime, intent.around, MOST)
        if made is None:  # he moved meanwhile, or it did
            raise Refused("", onward=self._seeks(state, intent))
        return made

    def _seeks(self, state: CharacterState, intent: Intent) -> Onward:
        """The beginning of seeking from a state."""
        leap = intent.leap
        waits = leap is not None and self._waits(state, leap, intent.around)
        return Onward(Seeking(self._looked_for(state, intent, waits, True)), 0, np.array(state.pose.root, float), None if leap is None else leap.place)

    def _looked_for(self, state: CharacterState, intent: Intent, parted: bool = False, goes_on: bool = False) -> Pieces[Found | tuple[str, np.ndarray | None, np.ndarray]]:
        """The jump that `intent.leap` asks for, in pieces; if there is none why, the nearest place (3,) that can be reached, and where (3,) it stands.
        parted: whether plans are pieces of it, too. goes_on: whether somebody goes on meanwhile, who is told no place by a footfall that he could come to from this one."""
        leap = intent.leap
        if leap is None:
            raise Refused("nobody asked for a jump")
        start, place, floor, here = self._meant(state, leap, intent.around)
        asked = start, place, floor, leap.airtime, intent.around
        known = self.again(leap.how, *asked) if isinstance(leap.how, How) else None
        if known is not None:
            return known
        looked = self.seen(*asked, parted)
        found, reason = (yield from looked) if parted else whole(looked)
        if found is not None:
            return found
        if leap.airtime is not None:
            looked = self.seen(start, place, floor, None, intent.around, parted)
            other, _ = (yield from looked) if parted else whole(looked)
            if other is not None and abs(other.made.path.airtime - leap.airtime) > 0.01:
                if len(intent.around) and whole(self.seen(start, place, floor, leap.airtime, (), False))[0] is not None:  # the body could
                    return f"{reason}; it could be made in {other.made.path.airtime:.2f} s", None, here
                if leap.place is None and leap.airtime > self.longest:
                    return f"too high: this body gets {self.highest:.2f} m up at most, in {self.longest:.2f} s, and {leap.airtime:.2f} s were asked", None, here
                return (f"{leap.airtime:.2f} s in the air is too {'long' if leap.airtime > other.made.path.airtime else 'short'} for this "
                        f"body there; the jump takes {other.made.path.airtime:.2f} s", None, here)
        if start.along:  # nowhere else, but in some other moment
            return reason, None, here
        if start.single is None and not self.path(start, place, floor, leap.airtime).strong:
            usual = self.path(start, here, floor, leap.airtime)
            if not usual.strong and usual.airtime > self.longest:
                return too_weak(self.physique, usual, self.longest), None, here
        ahead = (place - here) / max(float(np.linalg.norm(place - here)), 1e-9)
        if leap.slack > 0.0 and max((self.easy(start, floor) - place) @ ahead) > 0.0:  # else the nearest place is no farther on
            nearest, found = whole(self.nearby(*asked, within=leap.slack))
            if nearest is not None and found is not None and 0.0 < float((nearest - place) @ ahead) <= leap.slack:
                return found
        else:
            if leap.slack == 0.0:
                if goes_on and start.runs:
                    return reason, None, here
                yield reason
            nearest, found = yield from self.nearby(*asked)
            if nearest is not None and found is not None and np.linalg.norm(nearest - place) <= leap.slack and abs(nearest[1] - place[1]) <= LEVELS:
                return found
        return reason, nearest, here
