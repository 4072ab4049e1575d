# SPDX-License-Identifier: AGPL-3.0-or-later
"""Frames that are drawn without ranges can be used: by the tool's own count, on every bundled joint."""

import json

import pytest

from tooling import run

COARSE = ("--lines", 16, "--planes", 1, "--pixel", 1)


@pytest.mark.parametrize("name", ["simple-shoulder", "shoulder", "hip", "knee"])
def test_drawn_tips_are_in_the_picture_and_out_of_bone(tool, simple, tmp_path, name):
    run(tool, "sweep", "-j", simple.parent / f"{name}.artus", "--draw", 60, "--seed", 5, *COARSE, "-o",
        tmp_path / "set")
    said = json.loads(run(tool, "sweep", "stats", tmp_path / "set", "--json"))
    assert said["frames"] == 60 and said["with_needle"] > 30
    assert said["tip_in_picture"] >= 0.95 * said["with_needle"]
    assert said["tip_in"].get("bone", 0) == 0 and said["tip_in"].get("cartilage", 0) == 0
    assert sum(said["tip_in"].values()) == said["with_needle"]
