"""How evenly and how late live trackers are told, at every pace they send at: simulated networks, and this machine's own.

    python scripts/bench/live.py [--seconds 10]

A hand of Gambol's own walk is sent at 30 … 144 packets a second, seen at 60 frames a second. Jitter is the mean third derivative over
the hand's own; the rival is what most programs do: the newest packet counts. Late is by how much what is told lies behind
what was sent, of which the network and one packet are to be.
"""

from __future__ import annotations

import argparse
import socket
import time

import numpy as np
from pythonosc.osc_bundle_builder import IMMEDIATELY, OscBundleBuilder
from pythonosc.osc_message_builder import OscMessageBuilder
from scipy.interpolate import CubicSpline

from gambol.controllers.body import forward_kinematics
from gambol.controllers.contract import Intent
from gambol.controllers.locomotion import Locomotion
from gambol.controllers.reconstruction.live import Stream, Timeline

RATES = (30, 50, 60, 72, 90, 120, 144)
NETWORK = 0.004
"""What every packet takes [s]."""
AT_ONCE = 2e-4
"""Between packets that were held up [s]."""
FPS = 60


def walking_hand(seconds: float) -> CubicSpline:
    """The way (3,) [m] of a left hand that walks, turns, runs and stops, at any time [s]."""
    walker = Locomotion.load()
    state, roots, turns = walker.start(), [], []
    for k in range(round(120 * seconds)):
        wish = ((1.2, 0.0, 0.0), (0.8, 1.0, 0.0), (3.0, 0.0, 0.0), (0.0, 0.0, 0.0))[int(4 * k / (120 * seconds))]
        state, pose = walker.step(state, Intent(np.array(wish)), 1 / 120)
        roots.append(pose.root)
        turns.append(pose.rotations)
    places = forward_kinematics(walker.skeleton, np.array(roots, float), np.array(turns, float))[0]
    return CubicSpline(np.arange(len(places)) / 120, places[:, walker.skeleton.index("LeftHand")])


def restless(places: np.ndarray) -> float:
    """The mean third derivative [m/s³] of places (T, 3) at FPS."""
    return float(np.linalg.norm(np.diff(places, 3, axis=0), axis=-1).mean() * FPS**3)


def simulated(hand: CubicSpline, seconds: float, rate: float, unrest: float, loss: float, clock: bool, overtaking: bool = False, held: float = 0.0):
    """Jitter of what is told and of the newest packets, over the hand's own, and how late [s] what is told is. held: [s] for which the
    network holds packets up about once a second, to hand them over at once.
    """
    rng = np.random.default_rng(int(rate))
    sent = np.arange(0.0, seconds, 1.0 / rate)
    sent = sent[rng.random(len(sent)) >= loss]
    arrived = sent + NETWORK + np.abs(rng.normal(0.0, unrest, len(sent)))
    moment = 0.0
    while held and moment < seconds:
        moment += rng.uniform(0.7, 1.3)
        late = (arrived >= moment) & (arrived < moment + held)
        arrived[late] = moment + held + AT_ONCE * np.arange(late.sum())
    order = np.argsort(arrived, kind="stable")
    sent, arrived = (sent[order], arrived[order]) if (clock or overtaking) and not held else (sent, np.maximum.accumulate(arrived))
    line, told, newest, k = Timeline(), [], [], 0
    times = np.arange(1.0, seconds - 0.2, 1 / FPS)
    for now in times:
        while k < len(sent) and arrived[k] <= now:
            line.heard(arrived[k], hand(sent[k]), sent[k] if clock else None)
            k += 1
        told.append(line.at(now))
        newest.append(hand(sent[max(k - 1, 0)]))
    return *(restless(np.array(x)) / restless(hand(times)) for x in (told, newest)), delay(hand, times, np.array(told))


def delay(hand: CubicSpline, times: np.ndarray, told: np.ndarray) -> float:
    """By how much [s] places (T, 3) told at some times lie behind the hand."""
    return float(min(np.arange(0.0, 0.08, 2.5e-4), key=lambda d: np.linalg.norm(told - hand(times - d))))


def looped(hand: CubicSpline, seconds: float, rate: float):
    """The same over a socket of this machine, as a program with a head-set sends; in real time."""
    with Stream({"hand": "lwrist"}, 0, clock=time.monotonic) as stream, socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as out:
        began, sent, told, times = time.monotonic(), 0, [], []
        for frame in range(round(FPS * seconds)):
            due = frame / FPS
            while sent / rate <= due:
                time.sleep(max(0.0, began + sent / rate - time.monotonic()))
                message = OscMessageBuilder("/VMC/Ext/Tra/Pos")
                for value in ("hand", *(float(v) for v in hand(sent / rate) * [-1, 1, 1]), 0.0, 0.0, 0.0, 1.0):
                    message.add_arg(value)
                bundle = OscBundleBuilder(IMMEDIATELY)
                bundle.add_content(message.build())
                out.sendto(bundle.build().dgram, ("127.0.0.1", stream.port))
                sent += 1
            time.sleep(max(0.0, began + due - time.monotonic()))
            told.append(stream.at(began + due)[0])
            times.append(due)
    later = slice(FPS, None)
    times, told = np.array(times)[later], np.array(told)[later]
    return restless(told) / restless(hand(times)), delay(hand, times, told)


def main() -> None:
    """Print the tables."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--seconds", type=float, default=10.0, help="of each stream")
    seconds = parser.parse_args().seconds
    hand = walking_hand(seconds + 0.5)
    print(f"A packet takes {1000 * NETWORK:.0f} ms and is late by |normal|; 2 % are lost. Jitter over the hand's own: told (newest packet counts) · late, ms")
    print("  packets/s   even              3 ms late         … overtaking      8 ms late         3 ms late, sender's clock   8 ms late, overtaking, 10 % lost")
    for rate in RATES:
        cells = [simulated(hand, seconds, rate, *network) for network in
                 ((0.0, 0.0, False), (0.003, 0.02, False), (0.003, 0.02, False, True), (0.008, 0.02, False), (0.003, 0.02, True), (0.008, 0.1, False, True))]
        print(f"  {rate:9d}   " + "   ".join(f"{told:.2f} ({newest:.2f}) · {1000 * late:4.1f}" for told, newest, late in cells), flush=True)
    print("The network holds them up once a second, 2 ms late, 2 % lost")
    print("  packets/s   for 40 ms         80 ms             140 ms            40 ms, sender's clock   80 ms           140 ms")
    for rate in RATES:
        cells = [simulated(hand, seconds, rate, 0.002, 0.02, clock, held=held) for clock in (False, True) for held in (0.04, 0.08, 0.14)]
        print(f"  {rate:9d}   " + "   ".join(f"{told:.2f} ({newest:.2f}) · {1000 * late:4.1f}" for told, newest, late in cells), flush=True)
    print("This machine's own network, in real time, jitter · late, ms: ", end="", flush=True)
    print(", ".join(f"{rate}/s {told:.2f} · {1000 * late:.0f}" for rate in (60, 90) for told, late in [looped(hand, min(seconds, 5.0), rate)]))


if __name__ == "__main__":
    main()
