# SPDX-License-Identifier: AGPL-3.0-or-later
"""What several of the module's tests need."""

import subprocess

import numpy as np

import artus


def run(*command):
    done = subprocess.run([str(c) for c in command], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return done.stdout


def read_ply(path):
    """Vertices and triangles of a PLY with nothing else in it, text or little endian."""
    head, body = path.read_bytes().split(b"end_header\n", 1)
    words = head.decode().split()
    n, m = (int(words[words.index(w) + 1]) for w in ("vertex", "face"))
    if "ascii" in words:
        numbers = body.split()
        vertices = np.array(numbers[: 3 * n], float).reshape(n, 3)
        return vertices, np.array(numbers[3 * n :], int).reshape(m, 4)[:, 1:]
    kind = "<f8" if "double" in words else "<f4"
    vertices = np.frombuffer(body, kind, 3 * n).reshape(n, 3).astype(float)
    faces = np.frombuffer(body, np.dtype([("n", "u1"), ("v", "<i4", 3)]), m,
                          vertices.size * np.dtype(kind).itemsize)
    return vertices, faces["v"]


def straight_way(joint, n=300):
    """Times, needle poses and probe poses of a way to the first target and a rest there."""
    entry, target = joint.injections[0]
    axis = (target - entry) / np.linalg.norm(target - entry)
    deep = np.linalg.norm(target - entry)
    way = np.concatenate([np.linspace(-5e-3, deep, n), np.full(100, deep)])
    times = np.arange(len(way)) / 50
    return times, np.stack([artus.pose(entry + s * axis, axis) for s in way])
