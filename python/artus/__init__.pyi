# SPDX-License-Identifier: AGPL-3.0-or-later
from collections.abc import Iterable, Iterator, Mapping, Sequence
from os import PathLike
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

__version__: str

class Joint:
    """A compiled joint; share it between threads and renderers."""

    @property
    def name(self) -> str: ...
    @property
    def digest(self) -> str: ...
    @property
    def regions(self) -> list[str]: ...
    @property
    def tissues(self) -> list[str]: ...
    @property
    def probe(self) -> NDArray[np.float64]: ...
    @property
    def needle(self) -> NDArray[np.float64]: ...
    @property
    def injections(self) -> list[tuple[NDArray[np.float64], NDArray[np.float64]]]: ...
    @property
    def landmarks(self) -> dict[str, NDArray[np.float64]]: ...

class Frame:
    """A B-mode image and what led to it; arrays are read-only views that keep the frame alive."""

    @property
    def image(self) -> NDArray[np.uint8]: ...
    @property
    def in_phase(self) -> NDArray[np.float32]: ...
    @property
    def quadrature(self) -> NDArray[np.float32]: ...
    @property
    def envelope(self) -> NDArray[np.float32]: ...
    @property
    def decibel(self) -> NDArray[np.float32]: ...
    @property
    def velocity(self) -> NDArray[np.float32]: ...
    @property
    def motion_db(self) -> NDArray[np.float32]: ...
    @property
    def contact(self) -> NDArray[np.float32]: ...
    @property
    def pixel(self) -> float: ...
    @property
    def sample_depth(self) -> float: ...
    @property
    def tip_shown(self) -> tuple[float, float] | None: ...

class Labels:
    """What lies in the plane, at the scale of the image."""

    @property
    def regions(self) -> NDArray[np.uint16]: ...
    @property
    def needle(self) -> NDArray[np.uint8]: ...
    @property
    def pixel(self) -> float: ...

class Renderer:
    """Turns probe poses into B-mode images of one joint. `transducer`: a bundled name or a .toml
    file; `keep_lines`: frames keep (lines, samples) in_phase, quadrature, envelope and decibel;
    `gauge`: of the needle that is drawn; `look`: "raw", "clinical" or "compound";
    `grey_curve`: a bundled name or a .toml file."""

    def __init__(
        self,
        joint: Joint,
        transducer: str = "linear-6-18",
        keep_lines: bool = False,
        gauge: int = 22,
        *,
        width: float = ...,
        radius: float = ...,
        steering: float = ...,
        lines: int = ...,
        frequency: float = ...,
        bandwidth: float = ...,
        pulse_cycles: float = ...,
        f_number: float = ...,
        max_aperture: float = ...,
        elevation_height: float = ...,
        focus: float = ...,
        transmit_focus: float = ...,
        gain_db: float = 9,
        dynamic_range_db: float = 60,
        tgc_db_cm_mhz: float = 0.7,
        tgc_limit_db: float = 70,
        smoothing: float = 0,
        persistence: float = 0,
        clutter: bool = True,
        speckle_reduction: bool = True,
        grain: bool = True,
        grey_curve: str = "clinical",
        look: str = "clinical",
        depth: float = 40e-3,
        samples: int = 1024,
        planes: int = 5,
        speckle_db: float = -40,
        noise_db: float = -150,
        gel_limit: float = 5e-3,
        pixel: float = 0.1e-3,
        compound: int = 1,
        compound_spread: float = 0.14,
        doppler: bool = False,
        doppler_limit: float = 0.1,
        refraction: bool = True,
        reverberation: bool = True,
        frequency_downshift: bool = True,
        texture: bool = True,
        seed: int = 1,
        threads: int = 0,
    ) -> None: ...
    def render(
        self, probe: ArrayLike, needle: ArrayLike | None = None, time: float | None = None
    ) -> Frame: ...
    def labels(
        self, probe: ArrayLike, needle: ArrayLike | None = None, truth: str = "shown"
    ) -> Labels: ...
    def rf(self, probe: ArrayLike, needle: ArrayLike | None = None) -> dict[str, Any]: ...
    def truth(self, probe: ArrayLike, needle: ArrayLike) -> dict[str, Any]: ...

def load(
    path: str | PathLike[str],
    *,
    surfaces: str | PathLike[str] = "",
    cache: str | PathLike[str] = "",
    skip_refused: bool = False,
) -> Joint: ...
def compile(
    folder: str | PathLike[str],
    surfaces: Mapping[str, tuple[ArrayLike, ArrayLike]],
    *,
    cache: str | PathLike[str] = "",
) -> Joint: ...
def needle_intervals(
    joint: Joint, entry: ArrayLike, tip: ArrayLike
) -> list[tuple[str, float, float]]: ...
class Simulation:
    def __init__(
        self,
        joint: Joint,
        *,
        device: str = "virtuose_6d_desktop",
        transducer: str = "linear-6-18",
        haptic_rate: float = 1000.0,
        image_rate: float = 30.0,
        rigid: bool = False,
    ) -> None: ...
    def step(
        self,
        *,
        needle: ArrayLike | None = None,
        probe: ArrayLike | None = None,
        thumb: float = 0.0,
        plunger: float | None = None,
    ) -> dict[str, Any]: ...
    def render(self) -> NDArray[np.uint8]: ...
    @property
    def time(self) -> float: ...
    @property
    def refusal(self) -> str: ...

def forces(
    joint: Joint,
    poses: ArrayLike,
    probe: ArrayLike | None = None,
    *,
    rate: float = 1000.0,
    device: str = "ideal",
    rigid: bool = False,
) -> dict[str, NDArray[Any]]: ...
def insert(
    joint: Joint,
    entry: ArrayLike,
    target: ArrayLike,
    *,
    speed: float = 0.01,
    rate: float = 1000.0,
    device: str = "ideal",
    rigid: bool = False,
) -> dict[str, NDArray[Any]]: ...
def press(
    joint: Joint,
    probe: ArrayLike | None = None,
    *,
    depth: float | None = None,
    force: float | None = None,
    transducer: str = "linear-6-18",
) -> dict[str, Any]: ...
def pose(
    position: ArrayLike, z: ArrayLike, x: ArrayLike = (1.0, 0.0, 0.0)
) -> NDArray[np.float64]: ...
def sweep(
    joint: Joint,
    poses: Iterable[tuple[ArrayLike, ArrayLike | None]],
    *,
    start: int = 0,
    stop: int | None = None,
    step: int = 1,
    truth: str = "shown",
    **settings: Any,
) -> Iterator[dict[str, Any]]: ...
def inject(
    joint: Joint,
    entry: ArrayLike | None = None,
    target: ArrayLike | None = None,
    *,
    injection: str = "",
    into: str = "",
    volume: float = 5e-6,
    rate: float = 1e-7,
    liquid: str = "lidocaine",
    gauge: int = 22,
    needle_length: float = 0.05,
    syringe: float = 0.0,
    air: float = 0.0,
    aspirate: float = 3.0,
    technique: str = "direct",
    rigid: bool = False,
    haptic_rate: float = 1000.0,
    device: str = "virtuose_6d_desktop",
    seed: int = 1,
) -> dict[str, Any]: ...
def metrics(
    joint: Joint,
    times: ArrayLike,
    *,
    needle: ArrayLike | None = None,
    probe: ArrayLike | None = None,
    target: str | ArrayLike | None = None,
    avoid: Mapping[str, float] | None = None,
    gauge: int = 22,
    depth: float = 0.04,
) -> dict[str, Any]: ...
def assess(
    joint: Joint,
    recording: str | PathLike[str],
    *,
    target: str | ArrayLike | None = None,
    avoid: Mapping[str, float] | None = None,
    pictures: bool = True,
) -> dict[str, Any]: ...
