#!/usr/bin/env python3
"""ATE and drift over 20 m of trajectories against the truth: evaluate.py TRUTH.tum ESTIMATE.tum...

An estimate is evaluated with the stamp that suits it best: start, middle or end of the sweep (0, 0.05, 0.1 s).
Lost: a piece of 20 m that is 20 % off, or an ATE above 5 % of the way."""
import sys

import numpy as np

PIECE = 20.0


def load(name):
    rows = np.loadtxt(name, ndmin=2)
    return rows[:, 0], rows[:, 1:4], rows[:, 4:8]


def slerp(a, b, share):
    b = np.where((np.sum(a * b, axis=1) < 0)[:, None], -b, b)
    q = a + share[:, None] * (b - a)  # neighbours are 0.1 s apart
    return q / np.linalg.norm(q, axis=1)[:, None]


def rotations(q):
    x, y, z, w = q.T
    R = np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                  [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                  [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]])
    return np.moveaxis(R, 2, 0)


def truth_at(truth, stamps):
    t, p, q = truth
    i = np.clip(np.searchsorted(t, stamps, side="right") - 1, 0, len(t) - 2)
    share = (stamps - t[i]) / (t[i + 1] - t[i])
    return p[i] + share[:, None] * (p[i + 1] - p[i]), slerp(q[i], q[i + 1], share)


def ate(estimate, truth):
    a, b = estimate - estimate.mean(0), truth - truth.mean(0)
    U, _, Vt = np.linalg.svd(b.T @ a)
    R = U @ np.diag([1, 1, np.sign(np.linalg.det(U @ Vt))]) @ Vt
    return np.sqrt(np.mean(np.sum((a @ R.T - b) ** 2, axis=1)))


def drifts(p, R, tp, tR):
    way = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(tp, axis=0), axis=1))])
    found, following = [], 0.0
    for i, start in enumerate(way):
        if start < following:
            continue
        following = start + 0.5
        j = np.searchsorted(way, start + PIECE)
        if j == len(way):
            break
        motion = R[i].T @ (p[j] - p[i])
        true_motion = tR[i].T @ (tp[j] - tp[i])
        turned = (tR[i].T @ tR[j]).T @ (motion - true_motion)  # as the translation of inverse(true) * estimated
        found.append(np.linalg.norm(turned) / PIECE)
    return np.array(found), way[-1]


def evaluate(truth, name):
    stamps, p, q = load(name)
    best = None
    for offset in (0.0, 0.05, 0.1):
        at = stamps + offset
        inside = (at >= truth[0][0] - 1e-6) & (at <= truth[0][-1] + 1e-6)
        tp, tq = truth_at(truth, at[inside])
        error = ate(p[inside], tp)
        if best is None or error < best[0]:
            drift, length = drifts(p[inside], rotations(q[inside]), tp, rotations(tq))
            best = (error, drift, length, offset)
    error, drift, length, offset = best
    lost = drift.max() > 0.2 or error > 0.05 * length
    return (f"| {name} | {error:.4f} | {100 * drift.mean():.3f} | {100 * drift.max():.2f} | "
            f"{'lost' if lost else 'no'} | {length:.0f} m, {offset:.2f} s |")


if __name__ == "__main__":
    reference = load(sys.argv[1])
    for estimate in sys.argv[2:]:
        print(evaluate(reference, estimate))
