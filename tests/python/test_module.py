# SPDX-License-Identifier: AGPL-3.0-or-later
"""The module against the tool, and what its border refuses."""

import gc
import re
import resource
import subprocess
import sys
import threading
import time

import numpy as np
import pytest

import artus


def run(*command):
    done = subprocess.run([str(c) for c in command], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return done.stdout


def read_pgm(path):
    """8- and 16-bit PNG by hand, so that the tests need no picture library."""
    import struct
    import zlib

    data = path.read_bytes()
    at, compressed, width, height, depth = 8, b"", 0, 0, 0
    while at < len(data):
        (size,) = struct.unpack(">I", data[at : at + 4])
        kind, chunk = data[at + 4 : at + 8], data[at + 8 : at + 8 + size]
        if kind == b"IHDR":
            width, height, depth = struct.unpack(">IIB", chunk[:9])
        if kind == b"IDAT":
            compressed += chunk
        at += 12 + size
    raw, step = zlib.decompress(compressed), depth // 8
    row, rows, before = width * step, [], np.zeros(width * step, np.int64)
    for y in range(height):
        kind = raw[y * (row + 1)]
        line = np.frombuffer(raw, np.uint8, row, y * (row + 1) + 1).astype(np.int64)
        out = np.zeros(row, np.int64)
        for x in range(row):
            left = out[x - step] if x >= step else 0
            corner = before[x - step] if x >= step else 0
            up = before[x]
            if kind == 4:
                p = left + up - corner
                near = min((abs(p - left), 0), (abs(p - up), 1), (abs(p - corner), 2))[1]
                guess = (left, up, corner)[near]
            else:
                guess = (0, left, up, (left + up) // 2)[kind]
            out[x] = (line[x] + guess) % 256
        rows.append(out)
        before = out
    pixels = np.array(rows, np.uint8)
    return pixels if step == 1 else pixels.reshape(height, width, 2).view(">u2")[..., 0]


def test_image_has_the_bytes_of_the_tool(joint, tool, simple, tmp_path):
    run(tool, "image", "-j", simple, "--plain", "--needle", "default", "-o", tmp_path / "i.png")
    frame = artus.Renderer(joint).render(joint.probe, joint.needle)
    assert np.array_equal(frame.image, read_pgm(tmp_path / "i.png"))


def test_labels_have_the_bytes_of_the_tool(joint, tool, simple, tmp_path):
    p, z, x = 1e3 * joint.probe[:3, 3], joint.probe[:3, 2], joint.probe[:3, 0]
    text = [",".join(repr(float(v)) for v in t) for t in (p, z, x)]
    (tmp_path / "poses.jsonl").write_text(
        '{"probe": {"position_mm": [%s], "direction": [%s], "lateral": [%s]}}\n' % tuple(text)
    )
    run(tool, "sweep", "-j", simple, "--poses", tmp_path / "poses.jsonl", "-o", tmp_path / "s")
    renderer = artus.Renderer(joint)
    expected = read_pgm(tmp_path / "s/frames/000000-labels.png")
    assert np.array_equal(renderer.labels(joint.probe).regions, expected)
    image = read_pgm(tmp_path / "s/frames/000000.png")
    assert np.array_equal(renderer.render(joint.probe).image, image)


def test_needle_intervals_are_those_of_the_tool(joint, tool, simple):
    entry, target = joint.injections[0]
    text = [",".join(repr(float(1e3 * v)) for v in p) for p in (entry, target)]
    out = run(tool, "needle", "-j", simple, f"--entry={text[0]}", f"--tip={text[1]}")
    rows = [re.split(r"\s+", line)[:4] for line in out.splitlines()[1:]]
    ours = artus.needle_intervals(joint, entry, target)
    assert [r[0] for r in rows] == [region for region, _, _ in ours]
    for row, (_, first, last) in zip(rows, ours):
        assert float(row[2]) == pytest.approx(1e3 * first, abs=5e-4)
        assert float(row[3]) == pytest.approx(1e3 * last, abs=5e-4)


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
    artus.insert(joint, entry, target, speed=0.0005)
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
    with pytest.raises(ValueError, match="depth"):
        artus.Renderer(joint, depth=50)
    with pytest.raises(TypeError, match="unknown setting 'dept'"):
        artus.Renderer(joint, dept=0.05)
    with pytest.raises(FileNotFoundError, match="linear-6-18"):
        artus.Renderer(joint, transducer="linear")
    with pytest.raises(ValueError, match="keep_lines"):
        artus.Renderer(joint, lines=32, planes=1).render(joint.probe).envelope


def test_sweep_shares_its_list_between_workers(joint):
    settings = {"lines": 64, "planes": 1, "samples": 256}
    poses = [(joint.probe, joint.needle if i % 2 else None) for i in range(6)]
    whole = list(artus.sweep(joint, poses, **settings))
    shared = [f for k in range(3) for f in artus.sweep(joint, poses, start=k, step=3, **settings)]
    shared.sort(key=lambda f: f["index"])
    for a, b in zip(whole, shared, strict=True):
        assert np.array_equal(a["image"], b["image"])
        assert np.array_equal(a["regions"], b["regions"])
        assert a["truth"] == b["truth"]
    assert whole[0]["truth"] is None
    assert whole[1]["truth"]["tip"]


def test_surfaces_from_memory_are_compiled(source, tmp_path):
    folder = source / "meshes/simple-shoulder"
    with pytest.raises(ValueError, match="no structure 'patella'"):
        artus.compile(folder, {"patella": ([], [])})
    with pytest.raises(ValueError, match=r"vertices must have the shape \(n, 3\), not \(3,\)"):
        artus.compile(folder, {"bone": (np.zeros(3), np.zeros((1, 3)))})


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


def test_import_loads_no_codecs():
    out = run(sys.executable, "-c", "import artus; print(open('/proc/self/maps').read())")
    assert "libembree" in out
    for library in ("imgcodecs", "videoio", "avcodec", "glfw", "libGL"):
        assert library not in out


def test_the_package_runs_as_a_program(simple):
    out = run(sys.executable, "-m", "artus", simple)
    assert "simple-shoulder" in out and "bursa" in out
    assert subprocess.run([sys.executable, "-m", "artus", "no.artus"]).returncode == 1


def test_the_stub_names_what_the_module_has(source):
    stub = (source / "python/artus/__init__.pyi").read_text()
    named = set(re.findall(r"^(?:def|class) (\w+)|^(__version__)", stub, re.M))
    names = {a or b for a, b in named}
    assert names == set(artus.__all__)
    for cls in ("Joint", "Frame", "Labels", "Renderer"):
        body = re.search(rf"^class {cls}:.*?(?=^(?:class|def) )", stub, re.M | re.S).group()
        methods = set(re.findall(r"def (\w+)\(", body)) - {"__init__"}
        public = {m for m in dir(getattr(artus, cls)) if not m.startswith("_")}
        assert methods == public


def test_the_documents_example_runs(source, simple, tmp_path, monkeypatch):
    blocks = re.findall(r"```python\n(.*?)```", (source / "docs/python.md").read_text(), re.S)
    assert blocks
    monkeypatch.chdir(tmp_path)
    code = blocks[0].replace("meshes/simple-shoulder", str(simple))
    exec(compile(code, "docs/python.md", "exec"), {"__name__": "example"})
    assert (tmp_path / "view.pgm").stat().st_size > 1000


def test_pip_installs_without_network(source, tmp_path):
    """A wheel of the tree that is built, into a folder of its own."""
    from pathlib import Path

    build = Path(artus.__file__).resolve().parents[2]
    done = subprocess.run(
        [sys.executable, "-m", "pip", "install", "--no-index", "--no-deps", "--no-build-isolation",
         "--target", tmp_path / "site", "--config-settings", f"build-dir={build}", source],
        capture_output=True, text=True)
    if "No module named pip" in done.stderr:
        pytest.skip("pip is not there")
    assert done.returncode == 0, done.stderr
    out = run(sys.executable, "-c",
              f"import sys; sys.path.insert(0, {str(tmp_path / 'site')!r}); import artus; "
              "print(artus.__file__)")
    assert str(tmp_path) in out
