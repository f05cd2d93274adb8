"""Each search finds what looking at everything finds, or nearly."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.distance import cdist

from gambol.controllers.reconstruction import pose_vector as chart
from gambol.controllers.reconstruction.neighbours.cells import Cells, cluster, nearest
from gambol.controllers.reconstruction.neighbours.graph import Graph
from gambol.controllers.reconstruction.neighbours.lists import Lists, at_hand
from gambol.controllers.reconstruction.neighbours.search import Exact, Projection
from gambol.controllers.reconstruction.neighbours.segments import Segments
from gambol.controllers.reconstruction.neighbours.tree import Tree
from trajectories import database

JOINTS = tuple(chart.SKELETON.index(name) for name in ("LeftHand", "RightHand", "LeftFoot", "RightFoot"))
K = 30
KINDS = {"exact": Exact, "tree": lambda s: Tree(s, candidates=120), "cells": lambda s: Cells(s, candidates=120),
         "graph": lambda s: Graph(s, Cells(s, candidates=120), beam=120, expand=40)}
LEAST = {"exact": 1.0, "tree": 0.99, "cells": 0.98, "graph": 0.97, "lists": 0.98}
if at_hand():
    KINDS["lists"] = lambda s: Lists(s, candidates=120)


@pytest.fixture(scope="module")
def segments(tmp_path_factory):
    made = database(tmp_path_factory.mktemp("db") / "a", takes=24, count=250)
    return Segments.of(made, 3, 4, JOINTS)


@pytest.fixture(scope="module")
def searches(segments):
    return {kind: make(segments) for kind, make in KINDS.items()}


def performance(segments, recording, rng, count=25):
    """Queries in a row: what a recording would ask for, a little off."""
    first, end = segments.span(recording)
    features = segments.features(np.arange(first, end)[20:20 + count])
    return features + rng.normal(0, 0.02, features.shape).astype(np.float32)


def test_the_exact_search_is_exact(segments, searches):
    rng = np.random.default_rng(0)
    everything = segments.features(np.arange(len(segments)))
    for query in performance(segments, 3, rng, 5):
        distances = cdist(query[None], everything)[0]
        indices, found, _ = searches["exact"].query(query, K)
        assert np.allclose(found, np.sort(distances)[:K], rtol=1e-4)
        assert np.allclose(found, distances[indices], rtol=1e-4)


@pytest.mark.few(1)
@pytest.mark.parametrize("kind", KINDS)
def test_recall(segments, searches, kind):
    """Performed frame after frame, one's own recording forbidden; the hint is handed on."""
    rng, hits = np.random.default_rng(1), []
    for recording in range(0, 24, 5):
        hint, (first, end) = None, segments.span(recording)
        for query in performance(segments, recording, rng):
            truth, _, _ = searches["exact"].query(query, K, None, recording)
            found, distances, hint = searches[kind].query(query, K, hint, recording)
            assert len(set(found.tolist())) == K and np.all(np.diff(distances) >= 0)
            assert not np.any((found >= first) & (found < end))
            exact = np.sqrt(segments.squared_distances(query, found))
            assert np.allclose(distances, exact, rtol=1e-5)
            hits.append(np.isin(truth, found).mean())
    assert np.mean(hits) >= LEAST[kind]


@pytest.mark.parametrize("kind", KINDS)
def test_a_cold_start_in_the_middle_of_nowhere(searches, kind):
    """Far from everything there are still k nearest ones."""
    query = np.full(searches[kind].segments.width, 3.0, np.float32)
    truth, best, hint = searches["exact"].query(query, K)
    found, distances, hint = searches[kind].query(query, K, hint)
    assert len(found) == K and distances[0] <= 1.05 * best[0]


@pytest.mark.parametrize("kind", KINDS)
def test_more_than_there_are(tmp_path, kind):
    """With a recording forbidden, all the others come back; with all forbidden, none."""
    segments = Segments.of(database(tmp_path / "a", takes=2, count=20), 2, 1)
    search = KINDS[kind](segments)
    query, first = segments.features(np.array([0]))[0], segments.span(0)
    found, _, hint = search.query(query, 1000, None, 0)
    assert sorted(found.tolist()) == list(range(first[1], len(segments)))
    found, _, _ = search.query(query, 1000, hint, 0)
    assert len(found) == len(segments) - first[1]
    alone = Segments.of(segments.database.hold_out(clips=["clip0"])[1], 2, 1)
    found, distances, _ = KINDS[kind](alone).query(query, K, None, 0)
    assert found.shape == distances.shape == (0,)


@pytest.mark.parametrize("kind", KINDS)
def test_the_neighbourhood_is_what_was_found(segments, searches, kind):
    query = segments.features(np.array([100]))[0]
    near, _ = segments.neighbourhood(searches[kind], query, K)
    assert near.X.shape == (K, segments.width) and near.Y.shape == (K, chart.WIDTH)
    assert near.X.dtype == near.Y.dtype == near.distances.dtype == np.float32
    assert near.indices[0] == 100 and near.distances[0] < 1e-4
    assert np.allclose(np.linalg.norm(near.X - query, axis=-1), near.distances, atol=1e-4)


def test_links_go_to_many_takes(segments, searches):
    """At most four links lead to one take, none close to another or to the segment itself."""
    links, starts = searches["graph"].links, np.array([take.start for take in segments.database.takes])
    take = np.searchsorted(starts, segments.last, "right")
    for node in range(0, len(links), 97):
        there = links[node][links[node] >= 0]
        assert len(there) and np.bincount(take[there]).max() <= 4
        frames = np.sort(np.append(segments.last[there], segments.last[node]))
        assert np.diff(frames).min() >= 6


def test_principal_components_keep_what_varies(segments):
    projection = Projection.of(segments)
    features = segments.features(np.arange(len(segments)))
    inside = projection(features)
    assert np.allclose(projection.basis.T @ projection.basis, np.eye(inside.shape[1]), atol=1e-5)
    assert inside.var(0).sum() > 0.95 * features.var(0).sum()
    assert np.all(np.diff(inside.var(0)) <= 1e-6)


@settings(max_examples=10, deadline=None)
@given(st.integers(0, 2**32 - 1))
def test_every_point_is_in_the_cell_of_its_nearest_centre(seed):
    rng = np.random.default_rng(seed)
    points = rng.normal(0, 1, (300, 8)).astype(np.float32)
    centres, cell = cluster(points, 12, rng)
    distances = cdist(points, centres)
    assert np.allclose(distances[np.arange(300), cell], distances.min(1), atol=1e-5)
    assert np.array_equal(nearest(points, centres), cell)


def test_lists_from_disk_find_the_same(segments, searches, tmp_path):
    if "lists" not in searches:
        pytest.skip('Faiss is not installed: pip install -e ".[search]"')
    searches["lists"].save(tmp_path / "kept")
    again = Lists.load(tmp_path / "kept", segments)
    for query in performance(segments, 3, np.random.default_rng(5), 3):
        for one, two in zip(searches["lists"].query(query, K, None, 3), again.query(query, K, None, 3), strict=True):
            assert np.array_equal(one, two)
    (tmp_path / "kept" / "lists").write_bytes(b"nothing")
    with pytest.raises(ValueError, match="is no index"):
        Lists.load(tmp_path / "kept", segments)
