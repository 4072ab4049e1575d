# SPDX-License-Identifier: AGPL-3.0-or-later
"""Blood and moving tissue through the module."""
import os
import pathlib
import pickle

import numpy as np
import pytest

import artus


@pytest.fixture(scope="module")
def hip():
    return artus.load(pathlib.Path(os.environ["ARTUS_TEST_JOINTS"]) / "hip.artus")


def test_the_femoral_artery_beats(hip):
    renderer = artus.Renderer(hip, depth=60e-3, keep_lines=True, doppler=True, doppler_limit=0.6)
    probe = artus.pose([0.022, -0.064, 0.015], [0, 0.9, -0.43], [1, 0, 0])
    still = renderer.render(probe)
    assert np.isnan(still.velocity).all()
    systole = renderer.render(probe, time=0.125)
    artery = systole.velocity[96:160, 190:360]
    moving = ~np.isnan(artery)
    assert moving.sum() > 3000
    assert (artery[moving] < 0).all()
    assert -40 > np.median(systole.motion_db[96:160, 190:360][moving]) > -76
    assert (systole.image == still.image).all()
    back = renderer.render(probe, time=0.33).velocity[96:160, 190:360]
    assert (back[~np.isnan(back)] > 0).all()
    again = pickle.loads(pickle.dumps(systole))
    assert np.array_equal(again.velocity, systole.velocity, equal_nan=True)


def test_velocities_are_asked_for(hip):
    probe = hip.probe
    with pytest.raises(ValueError, match="doppler=True"):
        artus.Renderer(hip, keep_lines=True).render(probe).velocity
    with pytest.raises(ValueError, match="time"):
        artus.Renderer(hip, doppler=True).render(probe, time=float("nan"))
