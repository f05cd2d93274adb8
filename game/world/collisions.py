"""Characters who run into each other: bodies that meet faster than they brush past share their momentum, and each is struck by what it takes.

Two trunks are upright cylinders. As they touch and still close in, an impulse along the line between them leaves both as fast along it as if they had stuck together, but for a little
that flesh gives back. Who is down on the floor, or in the air over another, is met by nobody.

Who walks is held before who stands or lies as before a wall, and slides past shoulder to shoulder; nobody presses on into another.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from gambol.controllers.body import forward_kinematics
from gambol.controllers.contract import HARDEST, Intent, Strike, but
from gambol.controllers.navigation import in_frame, in_world
from gambol.controllers.supervisor import both

from ..scene import Box, Pillar, Prop
from .centre_of_mass import physique_of

TRUNK = 0.19
"""The radius of a body [m], at standard height, that others run into: shoulders turn, and arms give way, before it."""
LEAST, DEEP = (0.7, 0.35), 0.1
"""Who closes in slower than the first [m/s] is brushed past, where trunks only touch; slower than the second, where they are so deep in each other [m]."""
BACK = 0.1
"""Flesh gives back so much of the speed with which bodies meet."""
_TOUCH = Strike((0.0, 0.0))
WALKS, STANDS, PRESSES = 1.8, 0.3, 0.12
"""Who wishes to go no faster than the first [m/s] is held before who is slower than the second [m/s]; before others, and who runs, only as he is within the third of them [m]."""
STOPS = 0.45
"""Nobody who walks goes towards another faster than by what is left of the way in so much time [s]."""
LATE = 0.3
"""A gait takes up a wish so late [s]: until then a body goes on as it does."""
LIES, THICK = ("Hips", "Spine2", "Head", "LeftLeg", "RightLeg", "LeftFoot", "RightFoot"), 0.12
"""Joints of who is down that others walk past, and how thick he is about them [m], at standard height."""
TALL = 0.5
"""As high [m] others take who is down for, lest they step on him."""
GRID = 0.1
"""Whoever plans ahead is told to this where somebody lies [m]."""
TOUCHES, REACHED = 0.5, 3.5
"""Who is as near as the first [m], at standard height, may have struck another; who is farther than the second no other falls on."""
HIGH = 0.35
"""A pelvis that is lower over its floor than this share of the body's height belongs to who is down; one that is farther above another's stands over him."""


def run_into(characters: Sequence[Any], intents: Sequence[Intent], number: int) -> list[Intent]:
    """The intents of characters (`gambol.game.world.Character`), one for each, and how those are struck who run into each other after so many steps of the world; the very same of all
    others. Those count who are there and answer strikes, whoever moves them; who follows points or a camera meets nobody."""
    found = list(intents)
    who = [i for i, one in enumerate(characters) if one.there(number) and one.follows is None and one.watches is None
           and any(part.gain(_TOUCH) is not None for part in one.controller.parts.values())]
    if len(who) < 2:
        return found
    states, bodies = [characters[i].state for i in who], [physique_of(characters[i].controller) for i in who]
    ground, root = np.array([state.ground for state in states], float), np.array([state.pose.root for state in states], float)
    size, mass = np.array([body.size for body in bodies]), np.array([body.mass for body in bodies])
    flow = in_world(ground, np.array([state.velocity for state in states], float))
    high = HIGH * np.array([body.height for body in bodies])
    up = root[:, 1] - np.array([float(state.floor) for state in states]) > high
    apart = ground[:, None, :2] - ground[None, :, :2]
    far = np.linalg.norm(apart, axis=-1)
    meets = (far < TRUNK * (size[:, None] + size)) & up[:, None] & up & (np.abs(root[:, None, 1] - root[:, 1]) < np.minimum(high[:, None], high))
    for k, j in np.argwhere(np.triu(meets, 1)):
        along = apart[k, j] / max(float(far[k, j]), 1e-9)
        closing = -float((flow[k] - flow[j]) @ along)
        into = min((TRUNK * (size[k] + size[j]) - far[k, j]) / DEEP, 1.0)
        if closing > LEAST[0] + into * (LEAST[1] - LEAST[0]) and far[k, j] > 1e-9:
            hard = min((1.0 + BACK) * closing * mass[k] * mass[j] / (mass[k] + mass[j]), 0.5 * HARDEST) * along
            for one, impulse in ((k, hard), (j, -hard)):
                i = who[one]
                found[i] = but(found[i], strike=both(found[i].strike, Strike((float(impulse[0]), float(impulse[1])))))
    return found


def kept_apart(characters: Sequence[Any], intents: Sequence[Intent], number: int) -> list[Intent]:
    """The intents of characters (`gambol.game.world.Character`), one for each, with which those who walk as they are told are held before others, whoever moves these; the very same of
    all who go to a goal, leap, aim or are in the air."""
    found = list(intents)
    there = [i for i, one in enumerate(characters) if one.there(number)]
    if len(there) < 2:
        return found
    states, bodies = [characters[i].state for i in there], [physique_of(characters[i].controller) for i in there]
    ground, floor = np.array([state.ground for state in states], float), np.array([float(state.floor) for state in states])
    size, height = np.array([body.size for body in bodies]), np.array([body.height for body in bodies])
    moves, asked = np.array([state.velocity for state in states], float), np.array([intents[i].velocity for i in there], float)
    speed, pace = np.hypot(moves[:, 0], moves[:, 2]), np.hypot(asked[:, 0], asked[:, 2])
    held = (pace >= 1e-6) & np.array([_goes_as_told(characters[i], intents[i]) for i in there])
    discs, owner = [], []
    for k, i in enumerate(there):
        rows = [(*ground[k, :2], TRUNK * size[k])]
        if is_down(characters[i]):
            skeleton, pose = bodies[k].skeleton, states[k].pose
            joints = forward_kinematics(skeleton, np.asarray(pose.root, float), np.asarray(pose.rotations, float))[0]
            rows = [(*joints[skeleton.index(name), [0, 2]], THICK * size[k]) for name in LIES]
        discs += rows
        owner += [k] * len(rows)
    places, owners = np.array(discs), np.array(owner)
    apart = ground[:, None, :2] - places[:, :2]
    far = np.linalg.norm(apart, axis=-1)
    room = far - places[:, 2] - TRUNK * size[:, None]
    stays = (speed < STANDS)[owners] & (pace <= WALKS)[:, None]
    near = room < np.where(stays, STOPS * pace[:, None], PRESSES) + LATE * speed[:, None]
    near &= (owners != np.arange(len(there))[:, None]) & (np.abs(floor[owners] - floor[:, None]) < HIGH * height[:, None]) & (far > 1e-9)
    for k in np.flatnonzero(held & near.any(-1)):
        velocity, flow, slower = in_world(ground[k], asked[k]), in_world(ground[k], moves[k]), False
        for j in np.flatnonzero(near[k]):
            out = apart[k, j] / far[k, j]
            into = -float(velocity @ out) - max(float(room[k, j]) - LATE * max(-float(flow @ out), 0.0), 0.0) / STOPS
            if into > 0.0:
                velocity, slower = velocity + into * out, True
        if slower:
            found[there[k]] = but(intents[there[k]], velocity=in_frame(ground[k], velocity, asked[k, 1]))
    return found


def _goes_as_told(one: Any, intent: Intent) -> bool:
    """Whether somebody goes by his wished velocity alone: to no goal, after nobody, into no leap."""
    return one.follows is None and one.watches is None and intent.goal is None and intent.leap is None and intent.aim is None and one.state.active != "jump"


def lying(characters: Sequence[Any], number: int) -> tuple[Box, ...]:
    """What people who are down take of the floor, as boxes that others walk round."""
    found = []
    for one in characters:
        if one.there(number) and is_down(one):
            skeleton, size = one.controller.skeleton, physique_of(one.controller).size
            joints = forward_kinematics(skeleton, np.asarray(one.state.pose.root, float), np.asarray(one.state.pose.rotations, float))[0]
            places = joints[[skeleton.index(name) for name in LIES]][:, [0, 2]]
            along = places[LIES.index("Head")] - places[LIES.index("Hips")]
            heading = float(np.arctan2(along[0], along[1]))
            turned = places @ np.array([[np.cos(heading), np.sin(heading)], [-np.sin(heading), np.cos(heading)]])
            low, high = turned.min(0), turned.max(0)
            x, z = np.array([[np.cos(heading), np.sin(heading)], [-np.sin(heading), np.cos(heading)]]) @ (0.5 * (low + high))
            wide, deep = high - low + 2.0 * THICK * size
            found.append(Box((float(x), float(one.state.floor) + TALL / 2.0, float(z)), (float(wide), TALL, float(deep)), heading))
    return tuple(found)


def in_the_way(characters: Sequence[Any], number: int, props: tuple[Prop, ...], who: int) -> tuple[Prop, ...]:
    """What stands about for one of the characters who plans ahead, a way or a leap: the props, and who is down, as low pillars at his joints. Where these stand is told by a grid, so that
    nobody plans anew as a chest heaves; the very same props where nobody is down."""
    found = []
    for i, one in enumerate(characters):
        if i != who and one.there(number) and is_down(one):
            skeleton = one.controller.skeleton
            joints = forward_kinematics(skeleton, np.asarray(one.state.pose.root, float), np.asarray(one.state.pose.rotations, float))[0]
            places = GRID * np.round(joints[[skeleton.index(name) for name in LIES]][:, [0, 2]] / GRID)
            radius = THICK * physique_of(one.controller).size + 0.5 * GRID
            found += [Pillar((float(x), float(one.state.floor), float(z)), radius, TALL) for x, z in np.unique(places, axis=0)]
    return (*props, *found) if found else props


def falls_beside(characters: Sequence[Any], number: int, props: tuple[Prop, ...], who: int) -> tuple[Prop, ...]:
    """What stands about for one of the characters who is struck: what is in the way, and who stands, as a post as thick as his trunk, but for whom he touches, as that is who struck him."""
    found, here = [], np.asarray(characters[who].state.ground, float)[:2]
    for i, one in enumerate(characters):
        if i != who and one.there(number) and one.follows is None and one.watches is None and not is_down(one):
            body, (x, z) = physique_of(one.controller), np.asarray(one.state.ground, float)[:2]
            if TOUCHES < np.hypot(x - here[0], z - here[1]) / body.size < REACHED:
                found.append(Pillar((float(x), float(one.state.floor), float(z)), TRUNK * body.size, body.height))
    return (*in_the_way(characters, number, props, who), *found)


def is_down(one: Any) -> bool:
    """Whether a character is down on the floor: nobody's trunk to run into, but in the way."""
    return bool(one.state.pose.root[1] - float(one.state.floor) < HIGH * physique_of(one.controller).height)
