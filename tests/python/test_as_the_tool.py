# SPDX-License-Identifier: AGPL-3.0-or-later
"""What the module gives is what the tool gives, to the byte or the digit."""

import json
import re

import numpy as np
import pytest

import artus
from pictures import read_png
from tooling import run, straight_way


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
    expected = read_png((tmp_path / "s/frames/000000-labels_shown.png").read_bytes())
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


def test_an_injection_has_the_digits_of_the_tool(joint, tool, simple, tmp_path):
    run(tool, "inject", "-j", simple, "--volume-ml", "0.1", "--rate", "0.1", "--gauge", "23",
        "--aspirate", "0.5", "--seed", "4", "--no-images", "-o", tmp_path)
    ours = artus.inject(joint, volume=0.1e-6, rate=1e-7, gauge=23, aspirate=0.5, seed=4)
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
    assert told.pop("body")["pressed"]["measures"]  # which the tool alone measures
    assert {k: v for k, v in told.items() if k != "verdict"} == {
        k: v for k, v in ours["summary"].items() if k != "verdict"}
    assert told["given_ml"] > 0.05


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
