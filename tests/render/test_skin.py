"""Skinning as laws, and the shader against them."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from poses import CROUCH, HUMAN, STRIDE, figure
from scipy.spatial.transform import Rotation

from gambol.controllers.body import human
from gambol.game.character import twotone
from gambol.game.render import gl, mesh, skin
from gambol.game.render.view import scale_of

REST = figure()
LEVEL = dict(zip(mesh.LEVELS, mesh.mannequin().levels))
ALL = [figure(**STRIDE), figure(**CROUCH), figure(heading=2.0, LeftForeArm=(170, 0, 0), Head=(0, 80, 0))]


def skinned(posed, level="far", scale=1.0):
    shape = LEVEL[level]
    motion = skin.motions(posed.positions[None], posed.orientations[None], np.array([scale]))[0]
    return skin.skinned(shape.positions, shape.joints, shape.weights, motion, scale)


@pytest.mark.parametrize("level", mesh.LEVELS)
def test_the_mesh_is_whole(level):
    shape = LEVEL[level]
    edges = np.concatenate([shape.triangles[:, [0, 1]], shape.triangles[:, [1, 2]], shape.triangles[:, [2, 0]]])
    seen = {tuple(e) for e in edges.tolist()}
    assert len(seen) == len(edges), "two triangles run along an edge in the same direction"
    assert all((b, a) in seen for a, b in seen), "a hole"
    assert np.allclose(shape.weights.sum(1), 1.0, atol=1e-6) and shape.joints.max() < len(skin.NAMES)
    a, b, c = (shape.positions[shape.triangles[:, i]].astype(float) for i in range(3))
    volume = np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6.0
    assert 0.055 < volume < 0.085, "a human of 1.74 m displaces about 70 litres"
    face = np.cross(b - a, c - a)
    mean = shape.normals[shape.triangles].mean(1)
    assert (np.einsum("ij,ij->i", face, mean) > 0).mean() > 0.99


def test_soles_stand_on_the_floor_and_the_crown_at_full_height():
    y = LEVEL["near"].positions[:, 1]
    assert abs(y.min()) < 0.003 and abs(y.max() - 1.741) < 0.015


def test_the_t_pose_leaves_the_mesh_as_it_was_modelled():
    assert np.abs(skinned(REST) - LEVEL["far"].positions - [0, REST.positions[0, 1] - skin.REST[0, 1], 0]).max() < 1e-5


@pytest.mark.parametrize("posed", ALL)
@given(turn=st.tuples(*[st.floats(-3.0, 3.0)] * 3), shift=st.tuples(*[st.floats(-50.0, 50.0)] * 3))
@settings(max_examples=15, deadline=None)
def test_moving_the_whole_figure_moves_every_vertex_alike(posed, turn, shift):
    r, t = Rotation.from_rotvec(turn).as_matrix(), np.array(shift)
    moved = type(posed)(posed.positions @ r.T + t, r @ posed.orientations)
    assert np.abs(skinned(moved) - (skinned(posed) @ r.T + t)).max() < 1e-4


def test_a_larger_human_is_the_same_shape_larger():
    tall = figure(skeleton=human(2.1), **STRIDE)
    scale = scale_of(tall.positions, skin.REST, HUMAN.parents)
    assert abs(scale - 2.1 / 1.741) < 1e-6
    small = figure(**STRIDE)
    got = skinned(tall, scale=float(scale)) - tall.positions[0]
    assert np.abs(got - scale * (skinned(small) - small.positions[0])).max() < 1e-5


def girth(vertices, start, end, share):
    """Mean distance from the line between two points of the vertices near `share` of it."""
    axis = (end - start) / np.linalg.norm(end - start)
    along = (vertices - start) @ axis / np.linalg.norm(end - start)
    near = vertices[np.abs(along - share) < 0.06]
    across = near - start - np.outer((near - start) @ axis, axis)
    reach = np.linalg.norm(across, axis=1)
    return reach[reach < 0.08].mean()


@pytest.mark.parametrize("twist", [90, 150, -150])
def test_a_twisted_forearm_keeps_its_girth(twist):
    elbow, wrist = HUMAN.index("LeftForeArm"), HUMAN.index("LeftHand")
    posed = figure(LeftHand=(twist, 0, 0))
    for share in (0.3, 0.5, 0.7, 0.9):
        before = girth(skinned(REST, "near"), REST.positions[elbow], REST.positions[wrist], share)
        after = girth(skinned(posed, "near"), posed.positions[elbow], posed.positions[wrist], share)
        assert after > 0.9 * before


def test_folding_keeps_the_body_from_collapsing():
    shape = LEVEL["near"]

    def volume(posed):
        at = skinned(posed, "near")
        a, b, c = (at[shape.triangles[:, i]] for i in range(3))
        return np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6.0
    for posed in ALL:
        assert 0.93 < volume(posed) / volume(REST) < 1.1


def test_the_shader_skins_as_numpy_does(ctx):
    posed, shape = ALL[0], LEVEL["far"]
    program = gl.program(ctx, "skin_test.vert", "", varyings=("at", "towards"))
    motion = skin.motions(posed.positions[None], posed.orientations[None], np.ones(1))
    data = np.zeros((16 * 60 + 16, 4), np.float32)
    data[:60], data[960, 3] = motion.reshape(60, 4), 1.0
    block, out = ctx.buffer(data.tobytes()), ctx.buffer(reserve=len(shape.positions) * 24)
    block.bind_to_uniform_block(gl.FIGURES)
    vertices = ctx.buffer(shape.interleaved())
    array = ctx.vertex_array(program, [(vertices, "3f 3f 4u1 4f1 16x", "position", "normal", "joints", "weights")])
    somewhere = ctx.simple_framebuffer((4, 4))  # nothing is drawn, yet OpenGL wants a place
    somewhere.use()
    array.transform(out, ctx.POINTS)
    got = np.frombuffer(out.read(), np.float32).reshape(-1, 6)
    assert np.abs(got[:, :3] - skinned(posed)).max() < 1e-4
    for part in (array, vertices, block, out, program, somewhere):
        part.release()


def test_the_paint_that_is_cut_into_files_is_the_one_the_shader_draws(ctx):
    at = LEVEL["near"].paint.astype("f4")
    vertex = "#version 330 core\nvoid main() { gl_Position = vec4(gl_VertexID == 1 ? 3 : -1, gl_VertexID == 2 ? 3 : -1, 0, 1); }"
    fragment = gl.source("paint.glsl", {}) + ("\nuniform sampler2D places;\nout vec4 colour;\nvoid main() {"
                                              "colour = vec4(paint(texelFetch(places, ivec2(gl_FragCoord.xy), 0).xyz), 0, 1); }")
    program = ctx.program(vertex_shader=vertex, fragment_shader=fragment)
    width = 128
    rows = -(-len(at) // width)
    data = np.zeros((rows * width, 3), "f4")
    data[:len(at)] = at
    places, colour = ctx.texture((width, rows), 3, data.tobytes(), dtype="f4"), ctx.renderbuffer((width, rows), 4, dtype="f4")
    places.use(0)
    target, array = ctx.framebuffer([colour]), ctx.vertex_array(program, [])
    target.use()
    ctx.disable(ctx.DEPTH_TEST | ctx.CULL_FACE | ctx.BLEND)
    array.render(vertices=3)
    got = np.frombuffer(target.read(components=4, dtype="f4"), "f4").reshape(-1, 4)[:len(at), 0]
    wanted = twotone.field(at.astype(float))
    assert np.abs(got - wanted).max() < 1e-4 and (wanted > 0).any() and (wanted < 0).any()
    for part in (array, target, colour, places, program):
        part.release()


def test_cutting_two_materials_apart_leaves_the_surface_as_it_was():
    shape = LEVEL["near"]
    cut, dark = twotone.cut(shape)

    def area(mesh, triangles):
        a, b, c = (mesh.positions[triangles[:, i]].astype(float) for i in range(3))
        return 0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1).sum()
    assert abs(area(cut, cut.triangles) / area(shape, shape.triangles) - 1.0) < 1e-6
    assert 0.1 < area(cut, cut.triangles[dark]) / area(cut, cut.triangles) < 0.35
    middles = cut.paint[cut.triangles].mean(1).astype(float)
    sure = np.abs(twotone.field(middles)) > 0.004
    assert ((twotone.field(middles) > 0) == dark)[sure].mean() > 0.995
    edges = np.concatenate([cut.triangles[:, [0, 1]], cut.triangles[:, [1, 2]], cut.triangles[:, [2, 0]]])
    seen = {tuple(e) for e in edges.tolist()}
    assert len(seen) == len(edges) and all((b, a) in seen for a, b in seen), "still without holes"
    assert np.allclose(cut.weights.sum(1), 1.0, atol=1e-5)
