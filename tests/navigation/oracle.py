"""The same optimal control problem stated anew for casadi and IPOPT: Hermite-Simpson collocation, states and controls unknown."""

import casadi as ca
import numpy as np

FADE = 0.3


def least_cost(start, goal, weights, velocity=(0.0, 0.0, 0.0), limits=np.empty((0, 4)), steps=60, around=()):
    """The least cost (J, T, states (steps + 1, 6)) that IPOPT finds from several guesses; inf where it finds none.

    goal: (3,) reached as it is, whole turns and all. around: guesses (times, grounds) that are tried, too.
    """
    best = (np.inf, np.nan, None)
    towards = np.arctan2(goal[0] - start[0], goal[1] - start[1])
    options = [[None] * 3] + [[start[2], towards + turn, goal[2]] for turn in (-2 * np.pi, 0.0, 2 * np.pi)]
    for option in [*options, *around]:
        found = _solve(np.asarray(start, float), np.asarray(goal, float), weights, velocity, limits, steps, option)
        if found[0] < best[0]:
            best = found
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


def _solve(start, goal, w, velocity, limits, n, option):
    s, u, middle = ca.MX.sym("s", 6, n + 1), ca.MX.sym("u", 3, n + 1), ca.MX.sym("m", 3, n)
    total = ca.MX.sym("T")
    h = total / n
    cost, held = 0, [s[:, 0] - ca.DM([*start, *velocity]), s[:, n] - ca.DM([*goal, 0, 0, 0])]
    for k in range(n):
        a, b = _dynamics(s[:, k], u[:, k]), _dynamics(s[:, k + 1], u[:, k + 1])
        centre = (s[:, k] + s[:, k + 1]) / 2 + h / 8 * (a - b)
        held.append(s[:, k + 1] - s[:, k] - h / 6 * (a + 4 * _dynamics(centre, middle[:, k]) + b))
        cost += h / 6 * (_rate(s[:, k], u[:, k], goal, w) + 4 * _rate(centre, middle[:, k], goal, w)
                         + _rate(s[:, k + 1], u[:, k + 1], goal, w))
    held = ca.vertcat(*held)
    inside = ca.vec(ca.DM(limits[:, :3]) @ s[3:, 1:n] + ca.repmat(ca.DM(limits[:, 3]), 1, n - 1)) if len(limits) else ca.MX(0, 1)
    unknown = ca.vertcat(ca.vec(s), ca.vec(u), ca.vec(middle), total)
    solver = ca.nlpsol("walk", "ipopt", {"x": unknown, "f": cost, "g": ca.vertcat(held, inside)},
                       {"ipopt.print_level": 0, "print_time": 0, "ipopt.sb": "yes", "ipopt.max_iter": 500, "ipopt.tol": 1e-8})
    states, seconds = _guess(start, goal, w, n, option)
    first = np.concatenate([states.ravel(), np.zeros(3 * (2 * n + 1)), [seconds]])
    low = np.concatenate([np.zeros(held.shape[0]), np.full(inside.shape[0], -np.inf)])
    bound = np.concatenate([np.full(len(first) - 1, -np.inf), [0.05]])
    done = solver(x0=first, lbx=bound, lbg=low, ubg=np.zeros(len(low)))
    if not solver.stats()["success"]:
        return np.inf, np.nan, None
    x = np.array(done["x"]).ravel()
    return float(done["f"]), x[-1], x[:6 * (n + 1)].reshape(n + 1, 6)


def _guess(start, goal, w, n, option):
    share = np.linspace(0, 1, n + 1)
    states = np.zeros((n + 1, 6))
    if len(option) == 2:  # somebody's solution
        times, grounds = option
        rate = np.gradient(grounds, times, axis=0)
        c, s = np.cos(grounds[:, 2]), np.sin(grounds[:, 2])
        own = np.stack([s * rate[:, 0] + c * rate[:, 1], rate[:, 2], c * rate[:, 0] - s * rate[:, 1]], -1)
        for i in range(6):
            states[:, i] = np.interp(share, times / times[-1], np.hstack([grounds, own])[:, i])
        return states, times[-1]
    eased = share**2 * (3 - 2 * share)
    states[:, :3] = start + eased[:, None] * (goal - start)
    if option[0] is not None:
        states[:, 2] = np.interp(share, [0, 0.3, 0.7, 1.0], [option[0], option[1], option[1], option[2]])
    d = goal - start
    return states, (36 * (w[1] * (d[0] ** 2 + d[1] ** 2) + w[2] * d[2] ** 2) / w[0]) ** 0.25 + 0.5
