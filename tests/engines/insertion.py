# SPDX-License-Identifier: AGPL-3.0-or-later
"""The C interface through ctypes: insertion.py LIBRARY JOINT. Two simulations in one process."""
import ctypes
import math
import sys


class Options(ctypes.Structure):
    _fields_ = [("version", ctypes.c_uint32), ("rigid", ctypes.c_uint32), ("haptic_rate", ctypes.c_double),
                ("image_rate", ctypes.c_double), ("device", ctypes.c_char_p), ("transducer", ctypes.c_char_p)]


class Felt(ctypes.Structure):
    _fields_ = [("force", ctypes.c_double * 3), ("torque", ctypes.c_double * 3), ("probe_force", ctypes.c_double * 3),
                ("probe_torque", ctypes.c_double * 3), ("thumb_force", ctypes.c_double), ("depth", ctypes.c_double),
                ("given", ctypes.c_double), ("region", ctypes.c_uint32), ("status", ctypes.c_uint32),
                ("image_due", ctypes.c_uint32), ("reserved", ctypes.c_uint32)]


class Image(ctypes.Structure):
    _fields_ = [("grey", ctypes.POINTER(ctypes.c_uint8)), ("width", ctypes.c_uint32), ("height", ctypes.c_uint32),
                ("pixel", ctypes.c_double)]


def main():
    lib = ctypes.CDLL(sys.argv[1])
    lib.artus_open.restype = ctypes.c_void_p
    lib.artus_open.argtypes = [ctypes.c_char_p, ctypes.POINTER(Options)]
    lib.artus_last_error.restype = ctypes.c_char_p
    lib.artus_region_name.restype = ctypes.c_char_p
    lib.artus_region_name.argtypes = [ctypes.c_void_p, ctypes.c_uint32]
    pose = ctypes.POINTER(ctypes.c_double)
    lib.artus_step.argtypes = [ctypes.c_void_p, pose, pose, ctypes.c_double, ctypes.POINTER(Felt)]
    lib.artus_render.argtypes = [ctypes.c_void_p, ctypes.POINTER(Image)]
    lib.artus_plan.argtypes = [ctypes.c_void_p, ctypes.c_uint32, pose, pose]
    lib.artus_default_probe.argtypes = [ctypes.c_void_p, pose]
    lib.artus_free.argtypes = [ctypes.c_void_p]
    lib.artus_free.restype = None
    assert lib.artus_api_version() == 1
    options = Options()
    lib.artus_default_options(ctypes.byref(options))
    options.rigid = 1
    assert lib.artus_open(b"missing.artus", options) is None
    assert b"missing.artus" in lib.artus_last_error()
    results = []
    sims = [lib.artus_open(sys.argv[2].encode(), options) for _ in range(2)]
    assert all(sims), lib.artus_last_error()
    entry, target, probe = (ctypes.c_double * 3)(), (ctypes.c_double * 3)(), (ctypes.c_double * 7)()
    felt, image = Felt(), Image()
    for sim in sims:
        assert lib.artus_plan(sim, 0, entry, target) == 0
        assert lib.artus_default_probe(sim, probe) == 0
        length = math.dist(entry, target)
        way = [(t - e) / length for e, t in zip(entry, target)]
        norm = math.sqrt(2 + 2 * way[2])
        q = [(1 + way[2]) / norm, -way[1] / norm, way[0] / norm, 0]
        for tick in range(300):
            tip = [e + (-0.002 + 0.00003 * tick) * w for e, w in zip(entry, way)]
            assert lib.artus_step(sim, (ctypes.c_double * 7)(*tip, *q), probe, 0, felt) == 0, lib.artus_last_error()
        assert lib.artus_render(sim, image) == 0, lib.artus_last_error()
        grey = bytes(image.grey[: image.width * image.height])
        results.append((list(felt.force), felt.depth, lib.artus_region_name(sim, felt.region), grey))
    assert results[0] == results[1], "the same inputs give the same bytes"
    assert max(results[0][3]) > 50, "there is a picture"
    assert results[0][1] > 0.005
    for sim in sims:
        lib.artus_free(sim)
    print(results[0][:3], image.width, image.height)


main()
