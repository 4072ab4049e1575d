# SPDX-License-Identifier: AGPL-3.0-or-later
"""One layered model of a joint: its B-mode images, what a needle meets, and what the hand feels.

Lengths are metres, forces newton, poses 4 x 4 matrices X_JA of a frame A in the joint's frame J.
"""

from __future__ import annotations

import json
import shutil
import tempfile
import tomllib
from itertools import islice as _islice
from pathlib import Path

import numpy as _np

from ._artus import (
    Frame,
    Joint,
    Labels,
    Renderer,
    Simulation,
    __version__,
    _assess,
    _inject,
    _metrics,
    forces,
    insert,
    load,
    needle_intervals,
    press,
)

__all__ = [
    "Frame", "Joint", "Labels", "Renderer", "Simulation", "__version__", "assess", "compile", "forces", "inject",
    "insert", "load", "metrics", "needle_intervals", "pose", "press", "sweep",
]


def pose(position, z, x=(1.0, 0.0, 0.0)):
    """The (4, 4) pose at `position` (m) whose z axis is along `z` and x axis as near `x` as can be."""
    z = _np.asarray(z, float)
    if z.shape != (3,) or not _np.linalg.norm(z) > 0:
        raise ValueError("z must be three numbers, not all zero")
    z = z / _np.linalg.norm(z)
    x = _np.asarray(x, float)
    x = x - z * (x @ z)
    if _np.linalg.norm(x) < 1e-9:
        raise ValueError("x must not be along z")
    x = x / _np.linalg.norm(x)
    matrix = _np.eye(4)
    matrix[:3, 0], matrix[:3, 1], matrix[:3, 2], matrix[:3, 3] = x, _np.cross(z, x), z, position
    return matrix


def _write_ply(path, vertices, triangles):
    vertices = _np.ascontiguousarray(vertices, "<f8")
    triangles = _np.ascontiguousarray(triangles, "<i4")
    if vertices.ndim != 2 or vertices.shape[1] != 3:
        raise ValueError(f"{path.stem}: vertices must have the shape (n, 3), not {vertices.shape}")
    if triangles.ndim != 2 or triangles.shape[1] != 3:
        raise ValueError(f"{path.stem}: triangles must have the shape (n, 3), not {triangles.shape}")
    faces = _np.empty(len(triangles), _np.dtype([("n", "u1"), ("v", "<i4", 3)]))
    faces["n"], faces["v"] = 3, triangles
    head = (
        "ply\nformat binary_little_endian 1.0\n"
        f"element vertex {len(vertices)}\n"
        "property double x\nproperty double y\nproperty double z\n"
        f"element face {len(faces)}\nproperty list uchar int vertex_indices\nend_header\n"
    )
    path.write_bytes(head.encode() + vertices.tobytes() + faces.tobytes())


def compile(folder, surfaces, *, cache=""):
    """Compile a joint folder with surfaces from memory in place of some or all of its files.

    `surfaces`: {structure: (vertices (n, 3), triangles (m, 3))}, vertices in the units that the
    folder's joint.toml names; the body's own surface is called "body".
    """
    folder = Path(folder)
    table = tomllib.loads((folder / "joint.toml").read_text())
    files = {"body": table["body"]["file"]}
    files.update({s["name"]: s["file"] for s in table.get("structure", []) if "file" in s})
    unknown = sorted(set(surfaces) - set(files))
    if unknown:
        raise ValueError(f"the joint has no structure {unknown[0]!r}; it has {', '.join(files)}")
    with tempfile.TemporaryDirectory() as temporary:
        for name, file in files.items():
            target = Path(temporary) / file
            target.parent.mkdir(parents=True, exist_ok=True)
            if name not in surfaces:
                shutil.copy(folder / table.get("surfaces", ".") / file, target)
                continue
            if target.suffix.lower() != ".ply":
                raise ValueError(f"{name}: only .ply files can be replaced, not {file}")
            _write_ply(target, *surfaces[name])
        joint = load(folder, surfaces=temporary, cache=cache)
        joint._forget_source()  # its surfaces are in memory alone
        return joint


def _truth_of(renderer, frame, probe, needle):
    nowhere = _np.full(2, _np.nan, _np.float32)
    out = {"has_needle": needle is not None, "tip_true": nowhere.copy(), "tip_shown": nowhere.copy(),
           "tip_offset": _np.nan, "plane_angle": _np.nan, "face_angle": _np.nan,
           "tip_in_picture": False, "tip_in_slice": False, "in_plane": False}
    if needle is not None:
        out.update(renderer.truth(probe, needle))
        out["tip_true"] = _np.array(out["tip_true"], _np.float32)
    if frame.tip_shown is not None:
        out["tip_shown"] = _np.array(frame.tip_shown, _np.float32)
    return out


def sweep(joint, poses, *, start=0, stop=None, step=1, truth="shown", **settings):
    """Images and their truth, pose by pose: an iterator of dicts, for a training loop.

    `poses`: (probe (4, 4), needle (4, 4) or None) for each frame, a list or any iterable. With `start`
    and `step` several workers share one list: frame i does not depend on who draws it. `truth`: "shown",
    where the picture has things, "true", where they are, or "both". `settings`: of Renderer.

    Each dict can be batched as it is: index, image (height, width) uint8, regions_shown int32 ids and
    needle_shown uint8 masks (and the same _true), arrays that may be written to; tip_true and tip_shown
    (2,) float32 pixels, tip_offset m, plane_angle and face_angle rad, NaN where there is none;
    has_needle, tip_in_picture, tip_in_slice, in_plane.
    """
    if start < 0 or step < 1:
        raise ValueError("start must be at least 0 and step at least 1")
    if truth not in ("shown", "true", "both"):
        raise ValueError(f"truth must be shown, true or both, not {truth!r}")
    kinds = ("shown", "true") if truth == "both" else (truth,)
    renderer = Renderer(joint, **settings)
    return _sweep(renderer, poses, start, stop, step, kinds)


def _sweep(renderer, poses, start, stop, step, kinds):
    for i, (probe, needle) in enumerate(_islice(poses, stop)):
        if i < start or (i - start) % step:
            continue
        frame = renderer.render(probe, needle)
        item = {"index": i, "image": frame.image.copy()}
        for kind in kinds:
            labels = renderer.labels(probe, needle, truth=kind)
            item["regions_" + kind] = labels.regions.astype(_np.int32)
            item["needle_" + kind] = labels.needle.copy()
        yield {**item, **_truth_of(renderer, frame, probe, needle)}


def inject(joint, entry=None, target=None, *, injection="", into="", volume=5e-6, rate=1e-7,
           liquid="lidocaine", gauge=22, needle_length=0.05, syringe=0.0, air=0.0, aspirate=3.0,
           technique="direct", rigid=False, haptic_rate=1000.0, device="virtuose_6d_desktop",
           seed=1):
    """Inject with a simulated hand and thumb, as `artus inject` does: a dict of arrays.

    Along entry and target (3,) m, or a planned injection of the joint (its first without a name),
    or into a structure `into`. `volume`, `syringe`, `air`: m^3 (1e-6 is a millilitre); `rate`: m^3/s;
    `technique`: direct or through-and-back; `rigid`: tissue does not give way. Of each tick (n,): time s, depth m
    in the material, region id, axial N, thumb N, barrel_pressure and tip_pressure Pa, flow m^3/s, travel m, content m^3, status, phase
    (a list of words); volumes {place: (n,) m^3}; needle (4, 4) m where it flowed most; summary: what
    the tool writes into summary.json, in the units of its names.
    """
    arrays, summary = _inject(
        joint, entry, target, injection=injection, into=into, volume=volume, rate=rate, liquid=liquid,
        gauge=gauge, needle_length=needle_length, syringe=syringe, air=air, aspirate=aspirate,
        technique=technique, rigid=rigid, haptic_rate=haptic_rate, device=device, seed=seed)
    return {**arrays, "summary": json.loads(summary)}


def _goals(target, avoid):
    named = isinstance(target, str)
    return None if named else target, target if named else "", list((avoid or {}).items())


def metrics(joint, times, *, needle=None, probe=None, target=None, avoid=None, gauge=22, depth=0.04):
    """Measure tracked poses, as `artus assess --poses` does: the dict of its metrics.json.

    `times`: (n,) s that do not fall; `needle`, `probe`: (n, 4, 4) m, one or both; `target`: a
    structure's name or a point (3,) m; `avoid`: {structure: margin in m}; `gauge` of the needle and
    `depth` (m) of the picture decide what could be seen. Under "metrics" each number has its name,
    role, unit, value (None where the poses do not say) and definition.
    """
    return json.loads(_metrics(joint, times, needle, probe, *_goals(target, avoid), gauge, depth))


def assess(joint, recording, *, target=None, avoid=None, pictures=True):
    """Measure a recording of `serve`, `view` or `play` in its joint: a dict as of metrics().

    `pictures`: what was seen in them, as it was recorded; without, tip_visible is None.
    """
    return json.loads(_assess(joint, recording, *_goals(target, avoid), pictures))
