# SPDX-License-Identifier: AGPL-3.0-or-later
"""The module against the tool, and what its border refuses."""

import ast
import gc
import inspect
import json
import re
import resource
import subprocess
import sys
import threading
import time
import tomllib

import numpy as np
import pytest

import artus
from pictures import read_png


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


def test_image_has_the_bytes_of_the_tool(joint, tool, simple, tmp_path):
    run(tool, "image", "-j", simple, "--plain", "--needle", "default", "-o", tmp_path / "i.png")
    frame = artus.Renderer(joint).render(joint.probe, joint.needle)
    assert np.array_equal(frame.image, read_png((tmp_path / "i.png").read_bytes()))


def test_labels_have_the_bytes_of_the_tool(joint, tool, simple, tmp_path):
    p, z, x = 1e3 * joint.probe[:3, 3], joint.probe[:3, 2], joint.probe[:3, 0]
    text = [",".join(repr(float(v)) for v in t) for t in (p, z, x)]
    (tmp_path / "poses.jsonl").write_text(
        '{"probe": {"position_mm": [%s], "direction": [%s], "lateral": [%s]}}\n' % tuple(text)
    )
    run(tool, "sweep", "-j", simple, "--poses", tmp_path / "poses.jsonl", "-o", tmp_path / "s")
    renderer = artus.Renderer(joint)
    expected = read_png((tmp_path / "s/frames/000000-labels.png").read_bytes())
    assert np.array_equal(renderer.labels(joint.probe).regions, expected)
    image = read_png((tmp_path / "s/frames/000000.png").read_bytes())
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
    with pytest.raises(ValueError, match="virtuose"):
        artus.forces(joint, joint.needle[None], device="hand")
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


def test_the_surfaces_of_a_joint_compile_from_arrays_as_from_files(source, tmp_path):
    """Read by hand, given back as arrays: the same body, and so the same picture."""
    folder = source / "meshes/simple-shoulder"
    table = tomllib.loads((folder / "joint.toml").read_text())
    files = {"body": table["body"]["file"]} | {s["name"]: s["file"] for s in table["structure"]
                                               if "file" in s}
    surfaces = {n: read_ply(folder / table.get("surfaces", ".") / f) for n, f in files.items()}
    from_arrays = artus.compile(folder, surfaces, cache=tmp_path / "a")
    from_files = artus.load(folder, cache=tmp_path / "b")
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


def test_forces_have_the_digits_of_the_tool(joint, tool, simple, tmp_path):
    entry, target = joint.injections[0]
    axis = (target - entry) / np.linalg.norm(target - entry)
    tips = [entry + s * axis for s in np.linspace(-3e-3, 9e-3, 400)]
    lines = []
    for tip in tips:
        texts = [",".join(repr(float(1e3 * v)) for v in p) for p in (tip - 35e-3 * axis, tip)]
        lines.append('{"probe": {"position_mm": [0,0,0], "direction": [0,0,1]}, "needle": '
                     '{"entry_mm": [%s], "tip_mm": [%s]}}' % tuple(texts))
    (tmp_path / "p.jsonl").write_text("\n".join(lines) + "\n")
    run(tool, "force", "-j", simple, "--poses", tmp_path / "p.jsonl", "-o", tmp_path / "f.csv")
    rows = [line.split(",") for line in (tmp_path / "f.csv").read_text().splitlines()[1:]]
    # the poses as the tool reads them: in millimetres, through text
    poses = []
    for line in lines:
        pose = json.loads(line)["needle"]
        hub, tip = (np.array(pose[k]) * 1e-3 for k in ("entry_mm", "tip_mm"))
        poses.append(artus.pose(tip, tip - hub))
    felt = artus.forces(joint, np.stack(poses))
    assert len(rows) == 400 and felt["axial"].max() > 0.1
    ours = np.column_stack([felt["force"], felt["axial"], felt["torque"]])
    theirs = np.array([[float(v) for v in row[3:10]] for row in rows])
    assert np.allclose(theirs, ours, rtol=6e-9, atol=1e-12)  # the table has nine digits
    assert [row[2] for row in rows] == [joint.regions[r] for r in felt["region"]]
    assert [int(row[10]) for row in rows] == list(felt["status"])


def test_a_press_moves_the_picture_and_pushes_back(joint, renderer):
    pressed = artus.press(joint, depth=2e-3)
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
    with pytest.raises(ValueError, match="either depth"):
        artus.press(joint)
    with pytest.raises(ValueError, match="in metres"):
        artus.press(joint, depth=2)


def test_an_injection_has_the_digits_of_the_tool(joint, tool, simple, tmp_path):
    run(tool, "inject", "-j", simple, "--volume-ml", "0.2", "--rate", "0.1", "--gauge", "23",
        "--aspirate", "0.5", "--seed", "4", "--no-images", "-o", tmp_path)
    ours = artus.inject(joint, volume=0.2e-6, rate=1e-7, gauge=23, aspirate=0.5, seed=4)
    lines = (tmp_path / "trace.csv").read_text().splitlines()
    names = lines[0].split(",")
    rows = [dict(zip(names, line.split(","))) for line in lines[1:]]
    assert len(rows) == len(ours["time"]) > 1000
    assert ours["flow"].max() > 5e-8 and 0.1 < ours["thumb"].max() < 100
    for name, key, unit in [("time_s", "time", 1), ("depth_mm", "depth", 1e-3),
                            ("axial_n", "axial", 1), ("thumb_n", "thumb", 1),
                            ("tip_kpa", "tip_pressure", 1e3), ("flow_ml_s", "flow", 1e-6),
                            ("barrel_kpa", "barrel_pressure", 1e3), ("travel_mm", "travel", 1e-3)]:
        theirs = unit * np.array([float(row[name]) for row in rows])
        assert np.allclose(theirs, ours[key], rtol=6e-9, atol=1e-15), name
    assert [row["phase"] for row in rows] == ours["phase"]
    assert [row["region"] for row in rows] == [joint.regions[r] for r in ours["region"]]
    for place, volume in ours["volumes"].items():
        theirs = 1e-6 * np.array([float(row[f"{place}_ml"]) for row in rows])
        assert np.allclose(theirs, volume, rtol=6e-9, atol=1e-15), place
    told = json.loads((tmp_path / "summary.json").read_text())
    assert {k: v for k, v in told.items() if k != "verdict"} == {
        k: v for k, v in ours["summary"].items() if k != "verdict"}
    assert told["given_ml"] > 0.1


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


def straight_way(joint, n=300):
    """Times, needle poses and probe poses of a way to the first target and a rest there."""
    entry, target = joint.injections[0]
    axis = (target - entry) / np.linalg.norm(target - entry)
    deep = np.linalg.norm(target - entry)
    way = np.concatenate([np.linspace(-5e-3, deep, n), np.full(100, deep)])
    times = np.arange(len(way)) / 50
    return times, np.stack([artus.pose(entry + s * axis, axis) for s in way])


def test_metrics_are_those_of_the_tool(joint, tool, simple, tmp_path):
    times, needle = straight_way(joint)
    lines = []
    for time_s, pose in zip(times, needle):
        w = 0.5 * np.sqrt(max(0, 1 + np.trace(pose[:3, :3])))
        r = pose[:3, :3]
        assert w > 0.05
        q = [w, *((r[[2, 0, 1], [1, 2, 0]] - r[[1, 2, 0], [2, 0, 1]]) / (4 * w))]
        lines.append(json.dumps({"time_s": time_s, "needle": {
            "position_m": list(pose[:3, 3]), "quaternion_wxyz": q}}))
    (tmp_path / "way.jsonl").write_text("\n".join(lines) + "\n")
    told = json.loads(run(tool, "assess", "--poses", tmp_path / "way.jsonl", "-j", simple,
                          "--target", "bursa", "--avoid", "bone:2", "--json"))
    ours = artus.metrics(joint, times, needle=needle, target="bursa", avoid={"bone": 2e-3})
    assert [m["name"] for m in ours["metrics"]] == [m["name"] for m in told["metrics"]]
    for a, b in zip(ours["metrics"] + ours["perktutor"], told["metrics"] + told["perktutor"]):
        assert {**a, "value": 0} == {**b, "value": 0}
        assert (a["value"] is None) == (b["value"] is None), a["name"]
        if a["value"] is not None:  # the list went through text and quaternions
            assert a["value"] == pytest.approx(b["value"], rel=1e-6, abs=1e-6), a["name"]
    values = {m["name"]: m["value"] for m in ours["metrics"] if m["role"] == "needle"}
    way = 1e3 * np.linalg.norm(needle[-1, :3, 3] - needle[0, :3, 3])
    assert values["path_length_mm"] == pytest.approx(way, rel=0.01)
    assert [e["kind"] for e in ours["events"]].count("contact") == 1
    near = artus.metrics(joint, times, needle=needle, target=needle[-1, :3, 3] + [3e-3, 0, 0])
    (distance,) = [m for m in near["metrics"] if m["name"] == "distance_mm"]
    assert distance["value"] == pytest.approx(3, abs=0.05)


def test_a_recording_is_assessed_as_by_the_tool(tool, source, tmp_path, joint, simple):
    times, needle = straight_way(joint)
    rows = ["time_s,entry_x_mm,entry_y_mm,entry_z_mm,tip_x_mm,tip_y_mm,tip_z_mm,probe_x_mm,"
            "probe_y_mm,probe_z_mm,direction_x,direction_y,direction_z"]
    for time_s, pose in zip(times, needle):
        tip, hub = 1e3 * pose[:3, 3], 1e3 * (pose[:3, 3] - 35e-3 * pose[:3, 2])
        rows.append(",".join(repr(float(v)) for v in (
            time_s, *hub, *tip, *(1e3 * joint.probe[:3, 3]), *joint.probe[:3, 2])))
    (tmp_path / "way.csv").write_text("\n".join(rows) + "\n")
    # such a list leads a session wherever a recording is read
    led = json.loads(run(tool, "assess", tmp_path / "way.csv", "-j", simple, "--target", "bursa",
                         "--no-pictures", "--json"))
    peak = {m["name"]: m["value"] for m in led["metrics"]}
    assert any("force" in name and value and value > 0.05 for name, value in peak.items())
    with pytest.raises(FileNotFoundError, match="none.rec"):
        artus.assess(joint, tmp_path / "none.rec")
    with pytest.raises(ValueError, match="way.csv"):
        artus.assess(joint, tmp_path / "way.csv")


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


def test_import_loads_no_codecs():
    out = run(sys.executable, "-c", "import artus; print(open('/proc/self/maps').read())")
    assert "libembree" in out
    for library in ("imgcodecs", "videoio", "avcodec", "glfw", "libGL"):
        assert library not in out


def test_the_package_runs_as_a_program(simple):
    out = run(sys.executable, "-m", "artus", simple)
    assert "simple-shoulder" in out and "bursa" in out
    assert subprocess.run([sys.executable, "-m", "artus", "no.artus"]).returncode == 1


def stub_tree(source):
    return ast.parse((source / "python/artus/__init__.pyi").read_text())


def of_stub(function, method=False):
    """[(name, keyword alone, has a default)] of a function in the stub."""
    a = function.args
    plain = a.posonlyargs + a.args
    rows = [(p.arg, False, i >= len(plain) - len(a.defaults)) for i, p in enumerate(plain)]
    rows += [(p.arg, True, d is not None) for p, d in zip(a.kwonlyargs, a.kw_defaults)]
    return rows[1:] if method else rows


def of_module(function, method=False):
    """The same of a function of the module: pybind writes it into the first line of its docstring."""
    try:
        parameters = inspect.signature(function).parameters.values()
    except ValueError:
        head = function.__doc__.splitlines()[0]
        head = re.sub(r"array\[[^]]*\]", "array", re.sub(r"<[^>]*>", "0", head))  # types and values
        rest = head[head.index("(") + 1 : head.rindex(") ->")]
        rest = re.sub(r"\[[^\[\]]*\]", "", re.sub(r"\[[^\[\]]*\]", "", rest))  # Optional[...]
        rows, alone = [], False
        for part in (p.strip() for p in rest.split(", ")):
            if part == "*":
                alone = True
            elif not part.startswith("**"):
                rows.append((re.match(r"\w+", part).group(), alone, "=" in part))
        return rows[1:] if method else rows
    rows = [(p.name, p.kind == p.KEYWORD_ONLY, p.default is not p.empty)
            for p in parameters if p.kind != p.VAR_KEYWORD]
    return rows[1:] if method else rows


def test_the_stub_has_the_names_and_signatures_of_the_module(source):
    tree = stub_tree(source)
    functions = {n.name: n for n in tree.body if isinstance(n, ast.FunctionDef)}
    classes = {n.name: n for n in tree.body if isinstance(n, ast.ClassDef)}
    assert set(functions) | set(classes) | {"__version__"} == set(artus.__all__)
    for name, function in functions.items():
        assert of_stub(function) == of_module(getattr(artus, name)), name
    for name, body in classes.items():
        cls = getattr(artus, name)
        members = {m.name: m for m in body.body if isinstance(m, ast.FunctionDef)}
        assert set(members) - {"__init__"} == {m for m in dir(cls) if not m.startswith("_")}
        for member, function in members.items():
            is_property = any(getattr(d, "id", "") == "property" for d in function.decorator_list)
            assert is_property == isinstance(vars(cls).get(member), property), (name, member)
            if not is_property and member != "__init__":
                assert of_stub(function, True) == of_module(getattr(cls, member), True), member


def test_the_stub_names_every_setting_of_a_renderer(source, joint):
    (renderer,) = [n for n in stub_tree(source).body if getattr(n, "name", "") == "Renderer"]
    rows = of_stub(renderer.body[1], True)
    assert [r for r in rows if not r[1]] == of_module(artus.Renderer.__init__, True)
    with pytest.raises(TypeError) as refusal:
        artus.Renderer(joint, no_such_setting=1)
    offered = re.search(r"there are (.*)", str(refusal.value)).group(1).split(", ")
    assert [name for name, alone, _ in rows if alone] == offered


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
