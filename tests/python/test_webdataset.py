# SPDX-License-Identifier: AGPL-3.0-or-later
"""Shards as the package webdataset takes them, whose rules are written out here: it is not in Debian.

A sample is a run of members whose names agree up to the first dot of the last path component; the rest,
in small letters, is the member's key; a key may not come twice in a sample; members that are no regular
files, and names that begin with a dot or "__", are passed over. A decoder is chosen by a key's last
extension: "png" by "pil", "json" always.
"""

import io
import json
import re
import tarfile

import numpy as np
import pytest

from pictures import read_png
from tooling import run

KEYS = {"json", "png", "labels_shown.png", "shadow_shown.png", "needle_shown.png"}


def samples_of(path):
    with tarfile.open(path, "r|") as stream:  # as a pipe: members one after the other, no seeking
        current = None
        for member in stream:
            if not member.isreg() or re.search(r"(^|/)(\.|__)", member.name):
                continue
            stem, key = re.match(r"^((?:.*/|)[^.]+)[.]([^/]*)$", member.name).groups()
            if current is None or current["__key__"] != stem:
                if current is not None:
                    yield current
                current = {"__key__": stem}
            key = key.lower()
            assert key not in current, f"{member.name} comes twice"
            current[key] = stream.extractfile(member).read()
        if current is not None:
            yield current


@pytest.fixture(scope="module")
def shards(tool, simple, tmp_path_factory):
    folder = tmp_path_factory.mktemp("set")
    run(tool, "sweep", "-j", simple, "--draw", 10, "--seed", 3, "--frames-per-shard", 4, "--lines", 32,
        "--planes", 1, "--pixel", 0.5, "-o", folder)
    return sorted(folder.glob("shard-*.tar"))


def test_names_follow_the_brace_notation_without_a_gap(shards):
    # webdataset.WebDataset("shard-{000000..000002}.tar")
    assert [p.name for p in shards] == [f"shard-{i:06d}.tar" for i in range(3)]


def test_each_frame_is_one_sample_in_order(shards):
    samples = [s for path in shards for s in samples_of(path)]
    assert [s["__key__"] for s in samples] == [f"{i:09d}" for i in range(10)]
    for i, sample in enumerate(samples):
        truth = json.loads(sample["json"])
        assert truth["index"] == i
        assert set(sample) - {"__key__"} == KEYS
        assert "needle" in truth or not read_png(sample["needle_shown.png"]).any()
    assert {"needle" in json.loads(s["json"]) for s in samples} == {True, False}


def test_pictures_decode_as_eight_bits_of_one_channel(shards):
    for sample in samples_of(shards[0]):
        shapes = set()
        for key, data in sample.items():
            if not key.endswith("png"):
                continue
            assert data[24] == 8 and data[25] == 0  # bits, grey: "pil" makes 16 bits into colours
            shapes.add(read_png(data).shape)
        assert len(shapes) == 1  # image and masks can be stacked
        labels = read_png(sample["labels_shown.png"])
        listed = {r["id"] for r in json.loads(sample["json"])["regions"]}
        assert set(np.unique(labels)) == listed


def test_the_archive_is_plain_ustar_with_nothing_of_this_machine(shards):
    data = shards[0].read_bytes()
    assert len(data) % 512 == 0 and data[-1024:] == bytes(1024)
    with tarfile.open(fileobj=io.BytesIO(data)) as archive:
        assert archive.format == tarfile.USTAR_FORMAT or not archive.pax_headers
        for member in archive:
            assert member.isreg() and "/" not in member.name
            assert (member.mtime, member.uid, member.gid, member.mode) == (0, 0, 0, 0o644)
            assert (member.uname, member.gname) == ("", "")


def test_joined_shards_are_read_as_one(shards, tmp_path):
    # cat, as pipe:cat a.tar b.tar does; readers must be told to go on behind an archive's end
    (tmp_path / "all.tar").write_bytes(b"".join(p.read_bytes() for p in shards))
    with tarfile.open(tmp_path / "all.tar", ignore_zeros=True) as archive:
        stems = {n.split(".")[0] for n in archive.getnames()}
    assert len(stems) == 10
