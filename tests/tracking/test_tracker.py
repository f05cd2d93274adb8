"""A body followed through a film: five frames of a stride, pictures that lie, and filters beside it."""

import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

sys.path.insert(0, str(Path(__file__).parent))
from bodies import cameras, masks, stick_body, stride

from gambol.controllers.tracking import Tracker, TrackerSettings
from gambol.controllers.tracking.pose import Evidence
from gambol.controllers.tracking.rivals import KalmanFilter, OneEuro, savitzky_golay, smoothed
from gambol.controllers.tracking.twists import Configuration, exp, posed

RATE = 60.0


@pytest.fixture(scope="module")
def film():
    surface, lenses = stick_body(), cameras()
    truth = [stride(surface.chain, 0.1 + t / RATE) for t in range(9)]
    return surface, lenses, truth, [masks(surface, one, lenses) for one in truth]


def off(chain, one, other):
    return np.linalg.norm(posed(chain, one)[0] - posed(chain, other)[0], axis=1)


def followed(film, settings, frames, change=lambda t, seen: seen):
    surface, lenses, truth, seen = film
    tracker = Tracker(surface, lenses, RATE, settings)
    track = tracker.start(truth[1], truth[0])
    tracks = []
    for t in range(2, 2 + frames):
        track = tracker.step(track, change(t, seen[t]))
        tracks.append(track)
    return tracks


@pytest.mark.parametrize("penalty", [True, False])
def test_five_frames_are_followed(film, penalty):
    surface, _, truth, _ = film
    tracks = followed(film, TrackerSettings(penalty=penalty), 5)
    for t, track in enumerate(tracks, 2):
        assert off(surface.chain, track.now, truth[t]).mean() < 0.012
        assert track.fit.believed.all() and track.fit.residual < 0.6


def test_a_track_is_a_value(film):
    """The same state and masks give the same pose, to the bit, and leave what was before as it was."""
    one, two = followed(film, TrackerSettings(), 2), followed(film, TrackerSettings(), 2)
    assert np.array_equal(one[-1].now.root, two[-1].now.root) and np.array_equal(one[-1].now.angles, two[-1].now.angles)
    assert one[-1].before is one[0].now


def test_pictures_that_lie_are_left_out(film):
    """Two frames in which every camera shows something else; with the gate the pose goes on as predicted."""
    surface, _, truth, _ = film

    def lies(t, seen):
        return [np.roll(mask[::-1], 20, 1) for mask in seen] if t in (4, 5) else seen
    gated = followed(film, TrackerSettings(), 5, lies)
    open_ = followed(film, TrackerSettings(gate=False, penalty=False), 5, lies)
    assert not gated[2].fit.believed.any() and gated[4].fit.believed.all()
    assert off(surface.chain, gated[3].now, truth[5]).mean() < 0.03 < off(surface.chain, open_[3].now, truth[5]).mean()
    assert off(surface.chain, gated[4].now, truth[6]).mean() < 0.02


def test_who_was_led_astray_is_found_again_though_part_of_them_is_hidden(film):
    """Three frames of something else after a pace that was wrong; then a fifth of one silhouette is missing."""
    surface, lenses, truth, seen = film
    tracker = Tracker(surface, lenses, RATE)
    track = tracker.step(tracker.start(truth[1], truth[0]), seen[2])
    wild = np.random.default_rng(2).normal(size=len(surface.chain)) * 0.12
    usual = Evidence(np.full(4, 0.97), np.zeros(4, int))
    track = replace(track, before=Configuration(track.before.root, track.before.angles + wild), evidence=usual)
    for t in (3, 4, 5):
        track = tracker.step(track, [np.roll(mask[::-1], 20, 1) for mask in seen[t]])
        assert not track.fit.believed.any()
    assert off(surface.chain, track.now, truth[5]).mean() > 0.06
    rows = np.flatnonzero(seen[6][1].any(1))
    hidden = seen[6][1].copy()
    hidden[rows[len(rows) // 2]:rows[len(rows) // 2 + len(rows) // 7]] = False
    track = tracker.step(track, [seen[6][0], hidden, *seen[6][2:]])
    assert 0.75 < np.count_nonzero(hidden) / np.count_nonzero(seen[6][1]) < 0.87
    assert track.fit.believed.all() and off(surface.chain, track.now, truth[6]).mean() < 0.03


def test_a_dropped_frame_is_no_evidence(film):
    surface, _, truth, _ = film
    tracks = followed(film, TrackerSettings(), 3, lambda t, seen: [None, *seen[1:]])
    assert tracks[0].fit.believed.tolist() == [False, True, True, True]
    assert off(surface.chain, tracks[-1].now, truth[4]).mean() < 0.02


def test_as_many_masks_as_cameras(film):
    surface, lenses, truth, _ = film
    tracker = Tracker(surface, lenses)
    with pytest.raises(ValueError, match="4 cameras need as many masks or pictures, got 1"):
        tracker.step(tracker.start(truth[0]), [None])


@pytest.fixture(scope="module")
def pictures():
    """Seven frames of somebody dull before ground that runs from dark to light, with noise; and a picture with nobody in it."""
    surface, lenses, rng = stick_body(), cameras(160), np.random.default_rng(3)
    truth = [stride(surface.chain, 0.1 + t / RATE) for t in range(8)]
    plate = (60.0 + 0.6 * np.arange(160))[:, None] + np.array([[[0.0, 12.0, 4.0]]]) + np.zeros((160, 160, 1))

    def shown(mask):
        made = np.where(mask[..., None], 0.5 * plate + (70.0, 30.0, 20.0), plate) + rng.normal(size=plate.shape) * 4
        return np.clip(made, 0, 255).astype(np.uint8)
    return surface, lenses, truth, [[shown(mask) for mask in masks(surface, one, lenses)] for one in truth], shown(np.zeros((160, 160), bool))


@pytest.mark.few(1)
@pytest.mark.parametrize("plates", [False, True])
def test_pictures_are_followed(pictures, plates):
    surface, lenses, truth, seen, plate = pictures
    tracker = Tracker(surface, lenses, RATE, plates=(plate,) * 4 if plates else None)
    track = tracker.start(truth[1], truth[0])
    for t in range(2, 7):
        track = tracker.step(track, seen[t])
        assert track.fit.believed.all() and off(surface.chain, track.now, truth[t]).mean() < 0.03


def test_pictures_of_something_else_are_left_out(pictures):
    """Colours that do not go with the expected shape; the segmentation alone would find that shape anywhere."""
    surface, lenses, truth, seen, _ = pictures
    tracker, rng = Tracker(surface, lenses, RATE), np.random.default_rng(0)
    track = tracker.step(tracker.start(truth[1], truth[0]), seen[2])
    wild = [rng.integers(0, 256, (160, 160, 3), np.uint8), np.roll(seen[3][1][:, ::-1], 45, 1), seen[3][2], None]
    after = tracker.step(track, wild)
    assert after.fit.believed.tolist() == [False, False, True, False]
    assert off(surface.chain, after.now, truth[3]).mean() < 0.03


def test_masks_and_pictures_go_together(pictures):
    surface, lenses, truth, seen, _ = pictures
    tracker = Tracker(surface, lenses, RATE)
    track = tracker.step(tracker.start(truth[1], truth[0]), [*seen[2][:2], *masks(surface, truth[2], lenses)[2:]])
    assert track.fit.believed.all() and off(surface.chain, track.now, truth[2]).mean() < 0.02


def jittery(chain, seed=0, size=0.03):
    rng = np.random.default_rng(seed)
    truth = [stride(chain, t / RATE) for t in range(60)]
    noise = rng.normal(size=(60, 6 + len(chain))) * size
    noise[:, :6] *= 0.2
    return truth, [Configuration(one.root @ exp(n[:6]), np.clip(one.angles + n[6:], chain.lower, chain.upper)) for one, n in zip(truth, noise)]


def shake(chain, poses):
    return np.linalg.norm(np.diff(np.stack([posed(chain, one)[0] for one in poses]), 2, axis=0), axis=-1).mean()


@pytest.mark.parametrize("how", [OneEuro(RATE, 2.0, 0.3), KalmanFilter(RATE, 15.0, 0.03), "savitzky-golay"])
def test_filters_calm_and_leave_what_is_calm(how):
    chain = stick_body().chain
    truth, seen = jittery(chain)

    def filtered(poses):
        return savitzky_golay(chain, poses) if how == "savitzky-golay" else smoothed(chain, poses, how)
    made = filtered(seen)
    assert len(made) == 60 and shake(chain, made) < 0.5 * shake(chain, seen)
    still = [truth[0]] * 8
    for one in filtered(still):
        np.testing.assert_allclose(one.root, truth[0].root, atol=1e-9)
        np.testing.assert_allclose(one.angles, truth[0].angles, atol=1e-9)


def test_the_kalman_filter_is_the_textbooks():
    """One hinge against the equations in one dimension, written out."""
    chain = stick_body().chain
    d, dt, rng = chain.names.index("LeftLeg.x"), 1 / RATE, np.random.default_rng(1)
    values = 0.5 + 0.3 * np.sin(np.arange(30) * 0.2) + rng.normal(size=30) * 0.02
    poses = []
    for value in values:
        angles = chain.rest().angles.copy()
        angles[d] = value
        poses.append(Configuration(chain.rest().root, angles))
    made = [one.angles[d] for one in smoothed(chain, poses, KalmanFilter(RATE, 10.0, 0.02))]
    x, p = np.array([values[0], 0.0]), np.diag([0.02**2, 4.0])
    f = np.array([[1, dt], [0, 1]])
    g = np.array([dt * dt / 2, dt])
    want = [values[0]]
    for z in values[1:]:
        x, p = f @ x, f @ p @ f.T + 100.0 * np.outer(g, g)
        k = p[:, 0] / (p[0, 0] + 0.02**2)
        x, p = x + k * (z - x[0]), p - np.outer(k, p[0])
        want.append(x[0])
    np.testing.assert_allclose(made, want, atol=1e-9)


def test_savitzky_golay_keeps_a_cubic(film):
    from scipy.signal import savgol_filter

    chain = film[0].chain
    d, values = chain.names.index("LeftLeg.x"), 0.6 + 0.3 * np.sin(np.arange(40) * 0.3)
    poses = [Configuration(chain.rest().root, np.where(np.arange(len(chain)) == d, v, chain.rest().angles)) for v in values]
    made = [one.angles[d] for one in savitzky_golay(chain, poses, 4, 3)]
    np.testing.assert_allclose(made[4:-4], savgol_filter(values, 9, 3)[4:-4], atol=1e-9)


def test_settings_are_values():
    assert replace(TrackerSettings(), penalty=False) == TrackerSettings(penalty=False)
