# SPDX-License-Identifier: AGPL-3.0-or-later
import os
from pathlib import Path

import pytest

import artus

SIMPLE = Path(os.environ["ARTUS_TEST_JOINTS"]) / "simple-shoulder.artus"
TOOL = os.environ["ARTUS_TOOL"]
SOURCE = Path(__file__).resolve().parents[2]


@pytest.fixture(scope="session")
def joint():
    return artus.load(SIMPLE)


@pytest.fixture(scope="session")
def renderer(joint):
    return artus.Renderer(joint, lines=64, planes=1, samples=256, keep_lines=True)


@pytest.fixture(scope="session")
def tool():
    return TOOL


@pytest.fixture(scope="session")
def simple():
    return SIMPLE


@pytest.fixture(scope="session")
def bundled_cache():
    """Where the bodies of bundled joints are kept that the other tests have."""
    return SIMPLE.parent / "cache"


@pytest.fixture(scope="session")
def source():
    return SOURCE
