"""Others stand before whoever is followed, or nobody sees them: masks say what they can't tell, nobody flies off, and whoever was lost is found again."""

import sys
from pathlib import Path

import numpy as np
import pytest

sys.path.insert(0, str(Path(__file__).parent))
from bodies import cameras, masks, stick_body, stride

from gambol.controllers.tracking import Tracker
from gambol.controllers.tracking.pose import Evidence, brought, judged, observed, overlap, part_way
from gambol.controllers.tracking.silhouettes import HIDDEN, of_person, rendered, skinned
from gambol.controllers.tracking.twists import Configuration, exp, posed

RATE = 60.0


@pytest.fixture(scope="module")
def surface():
    return stick_body()


def off(chain, one, other):
    return np.linalg.norm(posed(chain, one)[0] - posed(chain, other)[0], axis=1)


def moved(where, by, turned=0.0):
    """A pose shifted [m], and turned about the vertical through its hips [rad]."""
    root = where.root.copy()
    root[:3, :3] = exp(np.array([0.0, 0.0, 0.0, 0.0, turned, 0.0]))[:3, :3] @ root[:3, :3]
    root[:3, 3] += by
    return Configuration(root, where.angles)


def people_seen(surface, lenses, *people):
    """Of each camera who is where, the nearer before the farther: 0 nobody, 1 the first, …"""
    out = []
    for lens in lenses:
        view, count = None, len(surface.triangles)
        for k, where in enumerate(people):
            view = rendered(lens, skinned(surface, *posed(surface.chain, where)[:2]), surface.triangles, view, first=k * count)
        out.append(np.where(view.triangles >= 0, 1 + view.triangles // count, 0).astype(np.uint8))
    return out


def test_a_mask_says_where_others_are():
    people = np.array([[0, 1, 1, 2]], np.uint8)
    assert of_person(people, 0).tolist() == [[0, 1, 1, HIDDEN]] and of_person(people, 1).tolist() == [[0, HIDDEN, HIDDEN, 1]]
    assert of_person(np.minimum(people, 1), 0).dtype == bool, "who is alone has a mask of yes and no"


def test_where_another_cuts_a_mask_there_is_no_contour(surface):
    lens = cameras()[0]
    seen = masks(surface, stride(surface.chain, 0.1), [lens])[0]
    other = np.zeros_like(seen)
    other[:, :48] = True
    cut = observed(lens, seen & ~other, other)
    whole, left = {tuple(at) for at in observed(lens, seen).contour.pixels}, {tuple(at) for at in cut.contour.pixels}
    assert left <= whole and {at for at in whole if at[0] > 48} <= left and len(left) > 50
    assert len(observed(lens, seen & ~other).contour) > len(left) + 5, "but for the other the cut is taken for a contour"


def test_what_is_hidden_does_not_count():
    one, other, hidden = np.zeros((3, 4, 4), bool)
    one[:2], other[1:3], hidden[2:] = True, True, True
    assert overlap(one, other) == pytest.approx(1 / 3) and overlap(one, other, hidden) == pytest.approx(1 / 2)
    assert np.isnan(overlap(one & other & hidden, one & other & hidden)), "nothing is said where nothing is"


def test_somebody_walks_past(surface):
    """Half a second in which another goes round whoever is followed, close by, before every camera in turn."""
    lenses, chain = cameras(), surface.chain
    truth = [stride(chain, 0.1 + t / RATE) for t in range(34)]
    other = [moved(one, [0.45 * np.sin(0.2 * t), 0.0, 0.45 * np.cos(0.2 * t)], 0.2 * t) for t, one in enumerate(truth)]
    tracker = Tracker(surface, lenses, RATE)
    worst = {}
    for told in (True, False):
        track, worst[told] = tracker.start(truth[1], truth[0]), 0.0
        for t in range(2, 34):
            people = people_seen(surface, lenses, truth[t], other[t])
            track = tracker.step(track, [of_person(one, 0) if told else one == 1 for one in people])
            worst[told] = max(worst[told], off(chain, track.now, truth[t]).max())
    assert worst[True] < 0.12 < worst[False]


def test_who_is_not_seen_comes_to_rest(surface):
    """1.8 m/s as everybody goes from sight: a tenth of a second more, and then half of it in each."""
    lenses, chain = cameras(), surface.chain
    now = stride(chain, 0.1)
    tracker = Tracker(surface, lenses, RATE)
    track, nothing = tracker.start(now, moved(now, [0.0, 0.0, -0.03])), [np.zeros(lens.size[::-1], bool) for lens in lenses]
    places = []
    for _ in range(90):
        track = tracker.step(track, nothing)
        places.append(track.now.root[2, 3] - now.root[2, 3])
    np.testing.assert_allclose(places[:6], 0.03 * np.arange(1, 7), atol=1e-6)
    assert places[-1] < 0.5 and places[-1] - places[-10] < 0.001 and track.unseen == 90


def test_nobody_goes_faster_than_people(surface):
    lenses, chain = cameras(), surface.chain
    now = stride(chain, 0.1)
    tracker = Tracker(surface, lenses, RATE)
    track = tracker.step(tracker.start(now, moved(now, [0.0, 0.0, -1.0])), [None] * 4)
    assert track.now.root[2, 3] - now.root[2, 3] == pytest.approx(0.2)


@pytest.mark.few(1)
@pytest.mark.parametrize("gone", [0, 2])
def test_who_was_lost_is_found_where_masks_show_them(surface, gone):
    """Unseen for a quarter of a second, and then 0.9 m farther on and turned by 80°; with two of the cameras, too."""
    lenses, chain = cameras()[gone:], surface.chain
    truth = [stride(chain, 0.1 + t / RATE) for t in range(26)]
    tracker = Tracker(surface, lenses, RATE)
    track = tracker.start(truth[1], truth[0])
    for t in range(2, 6):
        track = tracker.step(track, masks(surface, truth[t], lenses))
    for _ in range(6, 21):
        track = tracker.step(track, [np.zeros(lens.size[::-1], bool) for lens in lenses])
    back = [moved(one, [0.5, 0.0, 0.75], 1.4) for one in truth]
    for t in range(21, 26):
        track = tracker.step(track, masks(surface, back[t], lenses))
    assert off(chain, track.now, back[25]).mean() < 0.05 and track.unseen == 0


def test_brought_stays_as_far_away_as_one_camera_alone_had_them(surface):
    lens, chain = cameras()[0], surface.chain
    there = stride(chain, 0.1)
    (seen,) = masks(surface, there, [lens])
    aside = 0.6 * lens.rotation[0]
    found = brought(surface, [lens], [seen], [None], moved(there, aside))
    assert np.abs(found.root[:3, 3] - there.root[:3, 3]).max() < 0.08
    assert brought(surface, [lens], [seen & False], [None], there) is None


def test_a_camera_with_nothing_to_say_is_not_doubted():
    evidence, believed = judged(Evidence(np.array([0.9, 0.9]), np.array([0, 3])), np.array([np.nan, np.nan]))
    assert believed.all() and evidence.usual.tolist() == [0.9, 0.9] and not evidence.doubted.any()


def test_what_overlaps_with_nothing_is_never_believed():
    evidence = Evidence.fresh(1)
    for _ in range(20):
        evidence, believed = judged(evidence, np.array([0.05]))
        assert not believed.any()


def test_part_of_the_way(surface):
    chain = surface.chain
    one, other = stride(chain, 0.1), moved(stride(chain, 0.2), [0.3, 0.0, 0.1], 0.8)
    for share, end in ((0.0, one), (1.0, other)):
        assert off(chain, part_way(chain, one, other, share), end).max() < 1e-9
    half = part_way(chain, one, other, 0.5)
    np.testing.assert_allclose(half.root[:3, 3], 0.5 * (one.root + other.root)[:3, 3])
