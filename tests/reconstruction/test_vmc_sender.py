"""A body that is sent on: what another program would make of it, by an OSC reader of its own and a chain of its own."""

import socket

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from pythonosc.osc_packet import OscPacket
from scipy.spatial.transform import Rotation

from gambol.controllers.body import Pose, forward_kinematics, human
from gambol.controllers.reconstruction.live.vmc_sender import BONES, PORT, SURE, Sender, SenderError, address, bundle

PARENTS = {"Spine": "Hips", "Chest": "Spine", "UpperChest": "Chest", "Neck": "UpperChest", "Head": "Neck"} | {
    side + bone: parent if parent in ("Hips", "UpperChest") else side + parent for side in ("Left", "Right") for bone, parent in (
        ("Shoulder", "UpperChest"), ("UpperArm", "Shoulder"), ("LowerArm", "UpperArm"), ("Hand", "LowerArm"),
        ("UpperLeg", "Hips"), ("LowerLeg", "UpperLeg"), ("Foot", "LowerLeg"), ("Toes", "Foot"))}
"""Unity's humanoid, as its makers describe it."""


def heard(packet):
    return [timed.message for timed in OscPacket(packet).messages]


def chain(messages):
    """World places of all bones as a program in Unity's axes would have them."""
    found = {}
    for message in messages:
        if message.address in ("/VMC/Ext/Root/Pos", "/VMC/Ext/Bone/Pos"):
            name, place, turn = message.params[0], np.array(message.params[1:4]), Rotation.from_quat(message.params[4:8])
            if name == "root":
                found[name] = place, turn
            else:
                above, about = found[PARENTS.get(name, "root")]
                found[name] = above + about.apply(place), about * turn
    return {name: place for name, (place, _) in found.items()}


@given(st.integers(0, 2**32 - 1), st.floats(1.2, 2.1))
def test_another_program_finds_every_joint_where_it_is(seed, height):
    rng, skeleton = np.random.default_rng(seed), human(height)
    pose = Pose(rng.normal(size=3), Rotation.random(len(skeleton), random_state=rng).as_matrix())
    ground = rng.normal(size=3)
    places = chain(heard(bundle(skeleton, pose, ground, 1.0)))
    truth = forward_kinematics(skeleton, pose.root, pose.rotations)[0] * [-1.0, 1.0, 1.0]
    assert set(places) == {"root", *BONES.values()}
    for name, place in zip(skeleton.names, truth):
        assert np.allclose(places[BONES[name]], place, atol=1e-5)
    assert np.allclose(places["root"], [-ground[0], 0.0, ground[1]], atol=1e-6)


def test_a_standing_body_is_turned_by_nothing():
    """T-pose, facing ahead: every turn is none, as VRM has it."""
    skeleton = human()
    said = heard(bundle(skeleton, Pose(skeleton.offsets[0], np.tile(np.eye(3), (len(skeleton), 1, 1))), np.zeros(3), 0.0, 0.25))
    for message in said:
        if message.address.endswith("/Pos"):
            assert np.allclose(message.params[4:8], [0.0, 0.0, 0.0, 1.0])
    left = next(m for m in said if m.params[:1] == ["LeftUpperLeg"])
    assert left.params[1] < 0  # +X is to the right there
    assert [m.params for m in said if m.address == "/VMC/Ext/Blend/Val"] == [[SURE, 0.25]]
    assert [m.address for m in said][:1] == ["/VMC/Ext/OK"] and {"/VMC/Ext/T", "/VMC/Ext/Blend/Apply"} < {m.address for m in said}


def test_frames_arrive_and_nobody_listening_is_no_mistake():
    skeleton = human()
    pose = Pose(skeleton.offsets[0], np.tile(np.eye(3), (len(skeleton), 1, 1)))
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as listener:
        listener.bind(("127.0.0.1", 0))
        listener.settimeout(10.0)
        sender = Sender("127.0.0.1", listener.getsockname()[1])
        sender.send(skeleton, pose, np.zeros(3), 0.5)
        assert len(heard(listener.recv(65535))) == len(skeleton) + 5
    for k in range(5):
        sender.send(skeleton, pose, np.zeros(3), k / 60)
    sender.close()


@pytest.mark.parametrize("text, found", [("127.0.0.1", ("127.0.0.1", PORT)), ("studio:40000", ("studio", 40000)), (":40000", ("127.0.0.1", 40000)),
                                         ("[::1]", ("::1", PORT)), ("[fe80::2]:40000", ("fe80::2", 40000))])
def test_an_address_is_a_machine_and_a_port(text, found):
    assert address(text) == found


@pytest.mark.parametrize("text", ["a:b", "a:0", "a:65536", "a:", "a:1.5", "::1", "fe80::1:40000", "[::1", "[]:1:2"])
def test_an_address_with_a_mistake_is_told_of(text):
    with pytest.raises(SenderError, match="give HOST:PORT"):
        address(text)


def test_a_machine_that_is_none_is_told_of():
    with pytest.raises(SenderError, match="no machine that can be found"):
        Sender("no such machine.invalid")
