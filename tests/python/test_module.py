# SPDX-License-Identifier: AGPL-3.0-or-later
"""Arrays, threads, compiling, pressing: the module by itself, and what its border refuses."""

import pickle
import gc
import resource
import threading
import time
import tomllib

import numpy as np
import pytest

import artus
from tooling import read_ply


def test_forces_are_those_of_the_insertion(joint):
    entry, target = joint.injections[0]
    felt = artus.insert(joint, entry, target, speed=0.05)
    assert felt["force"].shape == (len(felt["axial"]), 3)
    assert felt["axial"].max() > 0.1
    assert felt["depth"].max() == pytest.approx(np.linalg.norm(target - entry), abs=5e-3)
    again = artus.insert(joint, entry, target, speed=0.05)
    assert all(np.array_equal(felt[key], again[key]) for key in felt)


def test_arrays_are_read_only_views_that_outlive_their_frame(joint, renderer):
    frame = renderer.render(joint.probe)
    image, envelope = frame.image, frame.envelope
    assert image.dtype == np.uint8 and not image.flags.owndata
    assert envelope.dtype == np.float32 and envelope.shape == (64, 256)
    assert image.__array_interface__["data"][0] == frame.image.__array_interface__["data"][0]
    kept = image.copy()
    with pytest.raises(ValueError):
        image[0, 0] = 1
    del frame
    gc.collect()
    other = joint.probe.copy()
    other[:3, 3] += 2e-3
    assert not np.array_equal(renderer.render(other).image, kept)
    assert np.array_equal(image, kept)


def test_two_threads_draw_what_one_draws(joint):
    settings = {"lines": 64, "planes": 1, "samples": 256, "threads": 1}
    poses = [joint.probe.copy() for _ in range(20)]
    for i, pose in enumerate(poses):
        pose[0, 3] += 1e-4 * i
    alone = [artus.Renderer(joint, **settings).render(p).image for p in poses]
    together = [None] * len(poses)

    def work(first):
        renderer = artus.Renderer(joint, **settings)
        for i in range(first, len(poses), 2):
            together[i] = renderer.render(poses[i]).image

    threads = [threading.Thread(target=work, args=(k,)) for k in range(2)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert all(np.array_equal(a, b) for a, b in zip(alone, together))


def test_others_run_while_the_engine_works(joint):
    entry, target = joint.injections[0]
    ticks, stop = [0], threading.Event()

    def count():
        while not stop.is_set():
            ticks[0] += 1
            time.sleep(0.001)

    thread = threading.Thread(target=count)
    thread.start()
    before = ticks[0]
    artus.insert(joint, entry, target, speed=0.01)
    during = ticks[0] - before
    stop.set()
    thread.join()
    assert during > 3


@pytest.mark.parametrize(
    "change, says",
    [
        (lambda p: p[:3], r"shape \(4, 4\), not \(3, 4\)"),
        (lambda p: np.where(np.arange(16).reshape(4, 4) == 7, np.nan, p), "row 1, column 3"),
        (lambda p: p @ np.diag([2, 2, 2, 1]), "not rigid"),
        (lambda p: p @ np.diag([-1, 1, 1, 1]), "not rigid"),
        (lambda p: p + np.eye(4)[[3, 3, 3, 0]] * [[0], [0], [0], [1]], "last row"),
    ],
)
def test_a_pose_that_is_none_is_refused_with_what_and_where(joint, renderer, change, says):
    with pytest.raises(ValueError, match=says):
        renderer.render(change(joint.probe))


def test_a_pose_in_millimetres_is_noticed(joint, renderer):
    far = joint.probe.copy()
    far[:3, 3] *= 1e3
    with pytest.raises(ValueError, match="millimetres"):
        renderer.render(far)
    with pytest.raises(ValueError, match=r"poses\[1\].*millimetres"):
        artus.forces(joint, np.stack([joint.needle, far]))
    with pytest.raises(ValueError, match="entry.*millimetres"):
        artus.needle_intervals(joint, [50.0, 0, 0], [0.0, 0, 0])


def test_what_the_engine_refuses_is_an_exception_with_its_message(joint, tmp_path):
    with pytest.raises(FileNotFoundError, match="nowhere"):
        artus.load(tmp_path / "nowhere.artus")
    (tmp_path / "bad.artus").write_bytes(b"not a joint")
    with pytest.raises(ValueError, match="bad.artus"):
        artus.load(tmp_path / "bad.artus")
    with pytest.raises(ValueError, match="virtuose"):
        artus.forces(joint, joint.needle[None], device="hand")
    with pytest.raises(ValueError, match="depth"):
        artus.Renderer(joint, depth=50)
    with pytest.raises(TypeError, match="unknown setting 'dept'"):
        artus.Renderer(joint, dept=0.05)
    with pytest.raises(ValueError, match="linear-6-18"):
        artus.Renderer(joint, transducer="linear")
    with pytest.raises(ValueError, match="keep_lines"):
        artus.Renderer(joint, lines=32, planes=1).render(joint.probe).envelope


def test_a_look_is_chosen_by_its_name(joint):
    settings = {"lines": 64, "planes": 1, "samples": 256}

    def picture(**look):
        return artus.Renderer(joint, **settings, **look).render(joint.probe).image

    assert (picture() == picture(look="clinical")).all()
    assert (picture(look="raw") != picture()).any()
    assert (picture(look="compound") != picture()).any()
    assert (picture(grey_curve="linear") != picture()).any()
    assert (picture(clutter=False) != picture()).any()
    with pytest.raises(ValueError, match="raw, clinical or compound"):
        picture(look="pretty")
    with pytest.raises(ValueError, match="hard"):
        picture(grey_curve="pretty")


def test_sweep_shares_its_list_between_workers(joint):
    settings = {"lines": 64, "planes": 1, "samples": 256}
    poses = [(joint.probe, joint.needle if i % 2 else None) for i in range(6)]
    whole = list(artus.sweep(joint, poses, **settings))
    shared = [f for k in range(3) for f in artus.sweep(joint, poses, start=k, step=3, **settings)]
    shared.sort(key=lambda f: f["index"])
    for a, b in zip(whole, shared, strict=True):
        assert np.array_equal(a["image"], b["image"])
        assert np.array_equal(a["regions_shown"], b["regions_shown"])
        assert np.array_equal(a["tip_true"], b["tip_true"], equal_nan=True)
    assert not whole[0]["has_needle"] and np.isnan(whole[0]["tip_true"]).all()
    assert not whole[0]["needle_shown"].any() and whole[1]["needle_shown"].any()
    drawn = list(artus.sweep(joint, (p for p in poses), start=1, stop=4, step=2, **settings))
    assert [f["index"] for f in drawn] == [1, 3]
    with pytest.raises(ValueError, match="start must be at least 0"):
        artus.sweep(joint, poses, start=-1, **settings)
    with pytest.raises(ValueError, match="shown, true or both"):
        artus.sweep(joint, poses, truth="real", **settings)


def test_a_sweeps_items_can_be_batched_as_they_are(joint):
    # what torch.utils.data.default_collate and from_numpy take: no None, no uint16, arrays that may
    # be written to, the same keys, kinds and shapes in each
    poses = [(joint.probe, joint.needle if i % 2 else None) for i in range(3)]
    items = list(artus.sweep(joint, poses, truth="both", lines=32, planes=1, samples=128))
    kinds = {np.dtype(np.uint8), np.dtype(np.int32), np.dtype(np.float32)}
    assert {"needle_shown", "needle_true", "regions_shown", "regions_true"} < set(items[0])
    for key, first in items[0].items():
        values = [item[key] for item in items]
        assert all(type(v) is type(first) for v in values), key
        if isinstance(first, np.ndarray):
            assert all(v.flags.writeable and v.dtype in kinds for v in values), key
            np.stack(values)
        else:
            assert isinstance(first, bool | int | float), key
    torch = pytest.importorskip("torch")
    batch = torch.utils.data.default_collate(items)
    assert batch["regions_shown"].shape == (3, *items[0]["regions_shown"].shape)


def test_what_is_pickled_comes_back_the_same(joint, tmp_path):
    renderer = artus.Renderer(joint, lines=32, planes=1, samples=128, gauge=20, keep_lines=True)
    frame = renderer.render(joint.probe, joint.needle)
    labels = renderer.labels(joint.probe, joint.needle)
    again = pickle.loads(pickle.dumps(renderer))
    for other in (pickle.loads(pickle.dumps(frame)), again.render(joint.probe, joint.needle)):
        assert np.array_equal(other.image, frame.image)
        assert np.array_equal(other.envelope, frame.envelope)
        assert other.tip_shown == frame.tip_shown and other.pixel == frame.pixel
    kept = pickle.loads(pickle.dumps(labels))
    assert np.array_equal(kept.regions, labels.regions) and np.array_equal(kept.needle, labels.needle)
    assert pickle.loads(pickle.dumps(joint)).digest == joint.digest
    with pytest.raises(TypeError, match="made in memory"):
        pickle.dumps(artus.press(joint, depth=1e-3)["joint"])


def test_truth_is_where_the_picture_shows_it_unless_it_is_asked_for(joint):
    renderer = artus.Renderer(joint, lines=64, planes=1, samples=512, look="raw")
    frame = renderer.render(joint.probe, joint.needle)
    truth = renderer.truth(joint.probe, joint.needle)
    moved = frame.tip_shown[1] - truth["tip_true"][1]
    shown = renderer.labels(joint.probe, joint.needle)
    real = renderer.labels(joint.probe, joint.needle, truth="true")
    lowest = [np.flatnonzero(l.needle.any(axis=1)).max() for l in (shown, real)]
    assert lowest[0] - lowest[1] == pytest.approx(moved, abs=1.5)
    with pytest.raises(ValueError, match="shown or true"):
        renderer.labels(joint.probe, truth="both")


def test_wrong_names_and_kinds_are_refused(joint):
    with pytest.raises(ValueError, match="linear-6-18"):
        artus.Renderer(joint, "linear-6-19")
    with pytest.raises(FileNotFoundError):
        artus.Renderer(joint, "nowhere.toml")
    with pytest.raises(TypeError):
        artus.Renderer(joint).render(joint.probe.astype(complex))


def test_surfaces_from_memory_are_compiled(source, tmp_path):
    folder = source / "meshes/simple-shoulder"
    with pytest.raises(ValueError, match="no structure 'patella'"):
        artus.compile(folder, {"patella": ([], [])})
    with pytest.raises(ValueError, match=r"vertices must have the shape \(n, 3\), not \(3,\)"):
        artus.compile(folder, {"bone": (np.zeros(3), np.zeros((1, 3)))})


def test_the_surfaces_of_a_joint_compile_from_arrays_as_from_files(source, bundled_cache, tmp_path):
    """Read by hand, given back as arrays: the same body, and so the same picture."""
    folder = source / "meshes/simple-shoulder"
    table = tomllib.loads((folder / "joint.toml").read_text())
    files = {"body": table["body"]["file"]} | {s["name"]: s["file"] for s in table["structure"]
                                               if "file" in s}
    surfaces = {n: read_ply(folder / table.get("surfaces", ".") / f) for n, f in files.items()}
    from_arrays = artus.compile(folder, surfaces, cache=tmp_path / "a")
    from_files = artus.load(folder, cache=bundled_cache)
    assert from_arrays.regions == from_files.regions
    settings = {"lines": 64, "planes": 1, "samples": 256}
    images = [artus.Renderer(j, **settings).render(j.probe, j.needle).image
              for j in (from_arrays, from_files)]
    assert np.array_equal(*images) and images[0].max() > 100
    # another body, another picture: the skin two millimetres farther out
    vertices, triangles = surfaces["body"]
    wider = artus.compile(folder, {"body": (vertices * 1.04, triangles)}, cache=tmp_path / "c")
    assert not np.array_equal(
        artus.Renderer(wider, **settings).labels(wider.probe).regions,
        artus.Renderer(from_files, **settings).labels(from_files.probe).regions)


def test_a_press_moves_the_picture_and_pushes_back(joint, renderer):
    pressed = artus.press(joint, depth=2e-3)
    assert pressed["short_of"] == 0
    assert pressed["settled"] and pressed["depth"] == 2e-3
    assert 0.05 < pressed["force"] < 20
    z = joint.probe[:3, 2]
    assert np.allclose(pressed["probe"][:3, 3], joint.probe[:3, 3] + 2e-3 * z)
    assert -pressed["force_J"] @ z == pytest.approx(pressed["force"])
    body = pressed["joint"]
    assert body.regions == joint.regions and body.digest != joint.digest
    before = renderer.labels(joint.probe).regions
    after = artus.Renderer(body, lines=64, planes=1, samples=256).labels(pressed["probe"]).regions
    assert before.shape == after.shape
    # the muscle below the middle of the face got thinner
    muscle = joint.regions.index("muscle")
    thickness = [(r[:, r.shape[1] // 2] == muscle).sum() for r in (before, after)]
    assert thickness[1] < thickness[0] - 2  # pixels of 0.1 mm
    deepest = artus.press(joint, depth=25e-3)
    assert 38 < deepest["force"] < 42 and deepest["short_of"] > 0
    assert deepest["depth"] + deepest["short_of"] == pytest.approx(25e-3)
    shorter = artus.press(joint, depth=2e-3, transducer="hockey-7-15")
    assert shorter["force"] != pressed["force"]
    with pytest.raises(Exception, match="only a straight probe"):
        artus.press(joint, depth=2e-3, transducer="curved-2-5")
    with pytest.raises(ValueError, match="either depth"):
        artus.press(joint)
    with pytest.raises(ValueError, match="in metres"):
        artus.press(joint, depth=2)


@pytest.mark.parametrize("change, says", [
    ({"volume": 5}, "volume must be .*1e-6 is a millilitre"),
    ({"volume": float("nan")}, "volume must be"),
    ({"rate": 0.1}, "a millilitre a second"),
    ({"liquid": "lidocain"}, "lidocaine"),
    ({"gauge": 24}, "there are 18, 19"),
    ({"into": "patella"}, "no structure"),
    ({"injection": "ninth"}, "planned injection"),
    ({"technique": "twice"}, "through-and-back"),
    ({"device": "hand"}, "hand"),
    ({"entry": [0, 0, 0]}, "both entry and target"),
    ({"entry": [0, 0, 0], "target": [0, 0, 0]}, "the same point"),
    ({"syringe": 1e-6}, "does not hold"),
])
def test_an_injection_that_cannot_be_is_refused_with_what_and_where(joint, change, says):
    with pytest.raises(ValueError, match=says):
        artus.inject(joint, **change)


def test_a_word_for_a_number_is_a_type_error(joint):
    with pytest.raises(TypeError, match="volume cannot be 'much'"):
        artus.inject(joint, volume="much")


@pytest.mark.parametrize("change, says", [
    ({"needle": None}, "needle, probe or both"),
    ({"times": [0, 2, 1]}, r"times\[2\]"),
    ({"times": [0, 1, float("nan")]}, r"times\[2\]"),
    ({"times": [0, 1]}, "3 poses for 2 times"),
    ({"times": [0, 1, 1e6]}, "in seconds"),
    ({"times": []}, r"shape \(n,\)"),
    ({"target": "brsa"}, "did you mean 'bursa'"),
    ({"target": [100.0, 0, 0]}, "millimetres"),
    ({"avoid": {"bone": 2}}, "in metres"),
    ({"avoid": {"nerv": 0.002}}, "no structure"),
    ({"gauge": 24}, "gauge"),
    ({"depth": 40}, "depth"),
])
def test_poses_that_cannot_be_measured_are_refused(joint, change, says):
    asked = {"times": [0, 1, 2], "needle": np.stack([joint.needle] * 3), **change}
    with pytest.raises(ValueError, match=says):
        artus.metrics(joint, **asked)


def test_frames_do_not_pile_up(joint):
    renderer = artus.Renderer(joint, lines=16, planes=1, samples=64, pixel=1e-3, threads=1)
    entry, target = joint.injections[0]
    count = 2000

    def memory():
        return int(open("/proc/self/statm").read().split()[1]) * resource.getpagesize()

    for _ in range(200):
        renderer.render(joint.probe).image.sum()
    before = memory()
    for _ in range(count):
        renderer.render(joint.probe).image.sum()
        renderer.labels(joint.probe).regions.max()
    assert memory() - before < 4e6
