"""From somebody's trackers through two sockets to another program's body, at every pace that trackers send at."""

import socket
from time import sleep

import numpy as np
import pytest
from pythonosc.osc_packet import OscPacket
from scipy.spatial.transform import Rotation

from gambol.controllers.body import STATURE, forward_kinematics
from gambol.controllers.contract import Intent
from gambol.controllers.locomotion import Locomotion, Settings
from gambol.controllers.reconstruction import Reconstruction
from gambol.controllers.reconstruction.control_points import parse
from gambol.controllers.reconstruction.live import Stream
from gambol.controllers.reconstruction.live.osc_packets import FROM_UNITY, MIRRORED
from gambol.controllers.reconstruction.live.vmc_sender import BONES, Sender
from gambol.controllers.reconstruction.pose_vector import SKELETON
from gambol.controllers.reconstruction.trackers import Network, Trackers
from test_stream import bundle
from test_turned_trackers import vmc
from test_vmc_sender import chain

WORN = ("head", "root", "lwrist", "rwrist", "lankle", "rankle")
SECONDS, FROM, FINE, LATENCY, UNREST, LOSS = 4.0, 1.5, 720, 0.004, 0.003, 0.02
SEEN = ("Head", "Hips", "LeftHand", "RightHand", "LeftFoot", "RightFoot", "LeftLeg", "RightLeg", "LeftForeArm", "RightForeArm")


@pytest.fixture(scope="module")
def performance():
    """Joint places (T, J, 3) and turns (T, J, 3, 3) of somebody who walks a bend and runs, FINE frames a second."""
    walker, roots, turns = Locomotion.load(settings=Settings(idle=0.0)), [], []
    state = walker.start()
    for k in range(round(SECONDS * 120)):
        state, pose = walker.step(state, Intent(np.array([1.2, 0.5, 0.0] if k < 300 else [2.8, 0.0, 0.0])), 1 / 120)
        roots.append(np.asarray(pose.root, float))
        turns.append(np.asarray(pose.rotations, float))
    fine, coarse = np.arange(round(SECONDS * FINE)) / FINE * 120, np.arange(len(roots))
    below = np.minimum(fine.astype(int), len(roots) - 2)
    share = np.minimum(fine - below, 1.0)
    between = [Rotation.from_matrix(np.array(turns)[below + k].reshape(-1, 3, 3)) for k in (0, 1)]
    step = (between[0].inv() * between[1]).as_rotvec() * np.repeat(share, len(SKELETON))[:, None]
    local = (between[0] * Rotation.from_rotvec(step)).as_matrix().reshape(len(fine), len(SKELETON), 3, 3)
    root = np.stack([np.interp(fine, coarse, np.array(roots)[:, i]) for i in range(3)], -1)
    return forward_kinematics(SKELETON, root, local)


def sent(controls, performance, moment):
    """What a program with trackers sends of a moment [s]."""
    k = min(round(moment * FINE), len(performance[0]) - 1)
    quaternions = Rotation.from_matrix(performance[1][k, controls.joints]).as_quat() * MIRRORED
    return bundle(*(vmc(f"LHR-{n}", place * FROM_UNITY, turn)
                    for n, (place, turn) in enumerate(zip(controls.on(performance[0][k], performance[1][k]), quaternions))))


def restless(places):
    return float(np.linalg.norm(np.diff(places, 3, axis=0), axis=-1).mean())


@pytest.mark.few(1)
@pytest.mark.parametrize("rate", [50, 60, 90, 144])
def test_another_program_shows_the_performer_calmly_and_one_packet_late(rate, performance):
    """3 ms of unrest, 2 % lost, some overtaken: by clocks that the test turns, over real sockets."""
    controls, rng, now = parse(",".join(WORN), SKELETON), np.random.default_rng(rate), [0.0]
    moments = np.arange(0.0, SECONDS, 1.0 / rate)
    moments = moments[rng.random(len(moments)) >= LOSS]
    arrivals = moments + LATENCY + np.abs(rng.normal(0.0, UNREST, len(moments)))
    order = np.argsort(arrivals, kind="stable")
    method = Trackers(Network.load(), controls)
    follower = Reconstruction(method, controls, STATURE, starts=method)
    state, k, shown, times = None, 0, [], []
    with Stream({f"LHR-{n}": name for n, name in enumerate(WORN)}, 0, clock=lambda: now[0]) as stream, \
            socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as worn, socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as screen:
        screen.bind(("127.0.0.1", 0))
        screen.settimeout(30.0)
        sender = Sender("127.0.0.1", screen.getsockname()[1])
        for frame in range(round(60 * (SECONDS - 0.2))):
            asked = frame / 60
            while k < len(order) and arrivals[order[k]] <= asked:
                now[0], before = arrivals[order[k]], len(stream._arrived)
                worn.sendto(sent(controls, performance, moments[order[k]]), ("127.0.0.1", stream.port))
                while len(stream._arrived) == before:
                    sleep(0.0)
                k += 1
            now[0] = asked
            points, turns = stream.at(asked), stream.turns
            if not np.isfinite(points).all():
                continue
            if state is None:
                state = follower.begin(points, turns=turns)
            else:
                state, _ = follower.step(state, Intent(points=points, turns=turns), 1 / 60)
            sender.send(follower.skeleton, state.pose, state.ground, asked)
            packet = screen.recv(65535)
            if asked >= FROM:
                bones = chain([timed.message for timed in OscPacket(packet).messages])
                shown.append([bones[BONES[name]] * FROM_UNITY for name in SEEN])
                times.append(asked)
        sender.close()
    shown, joints = np.array(shown), [SKELETON.index(name) for name in SEEN]

    def truth(late):
        return performance[0][np.round((np.array(times) - late) * FINE).astype(int)][:, joints]
    late = min(np.arange(0.0, 0.08, 1 / FINE), key=lambda one: np.linalg.norm(shown - truth(one)))
    assert late < LATENCY + UNREST + 1.0 / rate + 0.004, "the network's time and one packet"
    assert np.linalg.norm(shown - truth(late), axis=-1).mean() < 0.02
    assert restless(shown) < 1.7 * restless(truth(late))
