# SPDX-License-Identifier: AGPL-3.0-or-later
"""Lines before the envelope, read back from files as others read them: to the same picture."""

import json
import subprocess
import tarfile

import numpy as np
import pytest

import artus
from pictures import read_png
from tooling import run

VIEW = ("--look", "raw", "--needle", "default", "--lines", 64, "--planes", 1)


@pytest.fixture(scope="module")
def files(tool, simple, tmp_path_factory):
    folder = tmp_path_factory.mktemp("rf")
    for ending in ("npz", "uff"):
        done = run(tool, "image", "-j", simple, *VIEW, "--plain", "-o", folder / "i.png", "--rf",
                   folder / f"lines.{ending}", "--json")
        assert json.loads(done)["rf"] == str(folder / f"lines.{ending}")
    return folder


@pytest.fixture(scope="module")
def lines(files):
    return dict(np.load(files / "lines.npz"))


def picture_of(lines, pixel, shape):
    """Envelope, logarithm and scan conversion of a straight face, by numpy alone."""
    decibel = 20 * np.log10(lines["time_gain"] * np.abs(lines["iq"]) + 1e-10) + lines["gain_db"]
    n, samples = decibel.shape
    width = lines["face_width"]
    x = (-width / 2 + (np.arange(shape[1]) + 0.5) * pixel + width / 2) / (width / (n - 1))
    z = (np.arange(shape[0]) + 0.5) * pixel / lines["sample_depth"]
    i, k = np.clip(x.astype(int), 0, n - 2), np.clip(z.astype(int), 0, samples - 2)
    across, along = x - i, np.minimum(z - k, 1)[:, None]
    above = (1 - across) * decibel[i][:, k].T + across * decibel[i + 1][:, k].T
    below = (1 - across) * decibel[i][:, k + 1].T + across * decibel[i + 1][:, k + 1].T
    level = (1 - along) * above + along * below
    return np.clip(255 * (1 + level / lines["dynamic_range_db"]), 0, 255)


def test_the_envelope_of_the_lines_is_the_picture(files, lines):
    image = read_png((files / "i.png").read_bytes())
    ours = picture_of(lines, 0.1e-3, image.shape)
    assert image.std() > 20
    # half a grey of rounding and 0.01 dB of the fast logarithm
    assert np.abs(ours - image).max() < 0.6


def test_python_has_the_arrays_of_the_tool(joint, lines):
    renderer = artus.Renderer(joint, look="raw", lines=64, planes=1, keep_lines=True)
    ours = renderer.rf(joint.probe, joint.needle)
    assert set(ours) == set(lines)
    for key, value in lines.items():
        assert np.array_equal(ours[key], value), key
    assert ours["iq"].dtype == np.complex64 and ours["rf"].dtype == np.float32
    frame = renderer.render(joint.probe, joint.needle)
    assert np.allclose(ours["time_gain"] * np.abs(ours["iq"]), frame.envelope, rtol=1e-6, atol=0)
    with pytest.raises(ValueError, match="compound"):
        artus.Renderer(joint, look="compound", lines=32, planes=1).rf(joint.probe)


def test_rf_has_the_envelope_of_the_lines(lines):
    rf, iq = lines["rf"].astype(float), lines["iq"]
    factor = rf.shape[1] // iq.shape[1]
    assert lines["rf_sampling_frequency"] == factor * lines["sampling_frequency"]
    spectrum = np.fft.fft(rf, axis=1)
    spectrum[:, rf.shape[1] // 2 :] = 0
    envelope = np.abs(2 * np.fft.ifft(spectrum, axis=1))[:, ::factor]
    # off the line's ends, where it is cut; of each line's loudest echo
    inside = slice(40, -40)
    loudest = np.abs(iq).max(axis=1, keepdims=True)
    assert (np.abs(envelope - np.abs(iq)) / loudest)[:, inside].max() < 2e-3
    # its energy lies around the carrier
    power = np.abs(spectrum).sum(axis=0)[: rf.shape[1] // 2]
    centre = np.average(np.arange(len(power)), weights=power**2) / rf.shape[1]
    assert centre * lines["rf_sampling_frequency"] == pytest.approx(lines["centre_frequency"], rel=0.02)


def test_h5py_reads_the_same_from_uff(files, lines):
    h5py = pytest.importorskip("h5py")
    with h5py.File(files / "lines.uff") as file:
        assert file.attrs["version"][0] == b"v1.2.0"
        iq = file["iq/data/real"][0] + 1j * file["iq/data/imag"][0]  # (1, pixels), sample fastest
        assert np.array_equal(iq.reshape(lines["iq"].shape).astype(np.complex64), lines["iq"])
        assert np.array_equal(file["rf/data"][0].reshape(lines["rf"].shape), lines["rf"])
        assert np.allclose(file["iq/scan/x_axis"][0], lines["origins"][:, 0])
        assert np.allclose(np.diff(file["iq/scan/z_axis"][0]), lines["sample_depth"])
        assert file["iq/modulation_frequency"][0, 0] == lines["centre_frequency"]
        assert file["iq/pulse/center_frequency"][0, 0] == lines["centre_frequency"]
        kinds = {}
        file.visititems(lambda name, item: kinds.__setitem__(name, item.attrs["class"]))
    assert kinds["iq"] == kinds["rf"] == b"uff.beamformed_data"


def test_a_sweep_has_the_lines_of_each_frame(tool, simple, tmp_path):
    small = ("--lines", 32, "--planes", 1, "--pixel", 0.5, "--rf", "npz")
    run(tool, "sweep", "-j", simple, "--draw", 2, "--seed", 3, *small, "-o", tmp_path / "set")
    with tarfile.open(tmp_path / "set/shard-000000.tar") as shard:
        names = shard.getnames()
        assert "000000001.rf.npz" in names
        lines = np.load(shard.extractfile("000000001.rf.npz"))
        assert lines["iq"].shape == (32, 1024) and np.abs(lines["iq"]).max() > 0
    (tmp_path / "p.jsonl").write_text('{"probe": {"position_mm": [0,0,0], "direction": [0,0,1]}}\n')
    run(tool, "sweep", "-j", simple, "--poses", tmp_path / "p.jsonl", *small, "-o", tmp_path / "list")
    truth = json.loads((tmp_path / "list/truth.jsonl").read_text())
    assert np.load(tmp_path / "list" / truth["rf"])["iq"].shape == (32, 1024)


@pytest.mark.parametrize("flags, says", [
    (("--rf", "lines.mat"), ".npz, .uff, .h5 or .hdf5"),
    (("--rf", "lines.npz", "--compound", 3), "compound picture"),
    (("--rf", "lines.npz", "--look", "compound"), "compound picture"),
])
def test_what_has_no_lines_is_refused_before_it_is_drawn(tool, simple, tmp_path, flags, says):
    done = subprocess.run([tool, "image", "-j", simple, "-o", "i.png", *map(str, flags)], cwd=tmp_path,
                          capture_output=True, text=True)
    assert done.returncode != 0 and says in done.stderr
    assert not list(tmp_path.iterdir())
