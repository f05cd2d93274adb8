"""The same optimal control problem stated anew for casadi and IPOPT: Hermite-Simpson collocation, states and controls unknown."""

from functools import lru_cache

import casadi as ca
import numpy as np

FADE = 0.3


def least_cost(start, goal, weights, velocity=(0.0, 0.0, 0.0), limits=np.empty((0, 4)), steps=40, around=(), turns=(-1, 0, 1)):
    """The least cost (J, T, states (steps + 1, 6)) that IPOPT finds from several guesses; inf where it finds none.

    goal: (3,) reached as it is, whole turns and all. around: guesses (times, grounds) that are tried, too. turns: by how many whole
    turns the guesses are turned that look where they go.
    """
    start, goal = np.asarray(start, float), np.asarray(goal, float)
    solver, inside = _problem(steps, np.asarray(limits, float).tobytes())
    towards = np.arctan2(goal[0] - start[0], goal[1] - start[1])
    best = (np.inf, np.nan, None)
    for option in [None, *(towards + 2 * np.pi * turn for turn in turns), *around]:
        states, seconds = _guess(start, goal, weights, steps, option)
        first = np.concatenate([states.ravel(), np.zeros(3 * (2 * steps + 1)), [seconds]])
        held = 12 + 6 * steps
        done = solver(x0=first, p=[*start, *velocity, *goal, *weights], lbx=[-np.inf] * (len(first) - 1) + [0.05], ubg=0.0,
                      lbg=np.concatenate([np.zeros(held), np.full(inside, -np.inf)]))
        if solver.stats()["success"] and float(done["f"]) < best[0]:
            x = np.array(done["x"]).ravel()
            best = float(done["f"]), x[-1], x[:6 * (steps + 1)].reshape(-1, 6)
    return best


def _dynamics(s, u):
    """ṡ of s = (x, z, θ, v_f, ω, v_l) under accelerations."""
    return ca.vertcat(s[3] * ca.sin(s[2]) + s[5] * ca.cos(s[2]), s[3] * ca.cos(s[2]) - s[5] * ca.sin(s[2]), s[4], u)


def _rate(s, u, goal, w):
    dx, dz = goal[0] - s[0], goal[1] - s[1]
    angle = ca.atan2(dx, dz + 1e-12) - s[2]
    psi = ca.atan2(ca.sin(angle), ca.cos(angle))
    fade = 1 - ca.exp(-(dx**2 + dz**2) / FADE**2)
    return w[0] + w[1] * u[0] ** 2 + w[2] * u[1] ** 2 + w[3] * u[2] ** 2 + w[4] * fade * psi**2


@lru_cache
def _problem(n, limits):
    """The solver over n steps, and how many bounds velocities have in it."""
    limits = np.frombuffer(limits).reshape(-1, 4)
    s, u, middle = ca.MX.sym("s", 6, n + 1), ca.MX.sym("u", 3, n + 1), ca.MX.sym("m", 3, n)
    total, given = ca.MX.sym("T"), ca.MX.sym("p", 14)
    goal, w = given[6:9], given[9:]
    h = total / n
    cost, held = 0, [s[:, 0] - given[:6], s[:, n] - ca.vertcat(goal, 0, 0, 0)]
    for k in range(n):
        a, b = _dynamics(s[:, k], u[:, k]), _dynamics(s[:, k + 1], u[:, k + 1])
        centre = (s[:, k] + s[:, k + 1]) / 2 + h / 8 * (a - b)
        held.append(s[:, k + 1] - s[:, k] - h / 6 * (a + 4 * _dynamics(centre, middle[:, k]) + b))
        cost += h / 6 * (_rate(s[:, k], u[:, k], goal, w) + 4 * _rate(centre, middle[:, k], goal, w)
                         + _rate(s[:, k + 1], u[:, k + 1], goal, w))
    inside = ca.vec(ca.DM(limits[:, :3]) @ s[3:, 1:n] + ca.repmat(ca.DM(limits[:, 3]), 1, n - 1)) if len(limits) else ca.MX(0, 1)
    unknown = ca.vertcat(ca.vec(s), ca.vec(u), ca.vec(middle), total)
    options = {"ipopt.print_level": 0, "print_time": 0, "ipopt.sb": "yes", "ipopt.max_iter": 300, "ipopt.tol": 1e-7, "expand": True}
    return ca.nlpsol("walk", "ipopt", {"x": unknown, "f": cost, "g": ca.vertcat(*held, inside), "p": given}, options), inside.shape[0]


def _guess(start, goal, w, n, option):
    share = np.linspace(0, 1, n + 1)
    states = np.zeros((n + 1, 6))
    if isinstance(option, tuple):  # somebody's solution
        times, grounds = option
        rate = np.gradient(grounds, times, axis=0)
        c, s = np.cos(grounds[:, 2]), np.sin(grounds[:, 2])
        own = np.stack([s * rate[:, 0] + c * rate[:, 1], rate[:, 2], c * rate[:, 0] - s * rate[:, 1]], -1)
        for i in range(6):
            states[:, i] = np.interp(share, times / times[-1], np.hstack([grounds, own])[:, i])
        return states, times[-1]
    eased = share**2 * (3 - 2 * share)
    states[:, :3] = start + eased[:, None] * (goal - start)
    if option is not None:
        states[:, 2] = np.interp(share, [0, 0.3, 0.7, 1.0], [start[2], option, option, goal[2]])
    d = goal - start
    return states, (36 * (w[1] * (d[0] ** 2 + d[1] ** 2) + w[2] * d[2] ** 2) / w[0]) ** 0.25 + 0.5
