# SPDX-License-Identifier: AGPL-3.0-or-later
"""What pip asks for a wheel (PEP 517): CMake builds the module, and this packs it. Needs nothing but
the standard library and what scripts/setup installs.

Settings (pip install . --config-settings NAME=VALUE): build-dir=build/dev takes the module of a tree that is
built; carry=yes puts the libraries that it needs into the wheel (scripts/package).
"""

import base64
import hashlib
import os
import subprocess
import sys
import sysconfig
import tempfile
import tomllib
import zipfile
from pathlib import Path

from carried_libraries import carry

ROOT = Path(__file__).resolve().parents[1]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]


def _metadata():
    lines = ["Metadata-Version: 2.1", f"Name: {PROJECT['name']}", f"Version: {PROJECT['version']}"]
    lines += [f"License: {PROJECT['license']['text']}"]
    lines += [f"Requires-Python: {PROJECT['requires-python']}"]
    lines += [f"Requires-Dist: {name}" for name in PROJECT["dependencies"]]
    return "\n".join(lines) + "\n"


def _tag(system):
    python = f"cp{sys.version_info.major}{sys.version_info.minor}"
    return f"{python}-{python}-{system}"


def _bundled():
    """{path in the wheel: file} of joints and devices: where artus looks for them is beside its library."""
    files = {}
    for folder, kinds in (("meshes", (".toml", ".ply", ".artus")), ("devices", (".toml",))):
        for file in sorted((ROOT / folder).rglob("*")):
            if file.suffix in kinds and "generate" not in file.parts:
                files[f"artus/share/artus/{file.relative_to(ROOT)}"] = file
    return files


def _build(folder):
    subprocess.run(
        ["cmake", "-S", str(ROOT), "-B", str(folder), "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release",
         "-DARTUS_MODULE_ONLY=ON", f"-DPython3_EXECUTABLE={sys.executable}"], check=True)
    subprocess.run(["cmake", "--build", str(folder), "--target", "artus_python"], check=True)


def _digest(data):
    digest = base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()
    return f"sha256={digest},{len(data)}"


def get_requires_for_build_wheel(config_settings=None):
    return []


def _module(settings):
    given = settings.get("build-dir")
    folder = Path(given) if given else ROOT / "build" / "wheel"
    if not folder.is_absolute():
        folder = ROOT / folder
    if not given:
        _build(folder)
    package = folder / "python" / "artus"
    modules = sorted(package.glob("_artus*" + sysconfig.get_config_var("EXT_SUFFIX")))
    if not modules:
        raise RuntimeError(f"{package} has no module for this Python; are pybind11-dev and "
                           "python3-dev there (scripts/setup)?")
    return modules[0]


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    settings = config_settings or {}
    module = _module(settings)
    with tempfile.TemporaryDirectory() as scratch:
        if settings.get("carry") == "yes":
            carried, licences, system = carry(module, Path(scratch))
        else:
            carried, licences = {f"artus/{module.name}": module}, {}
            system = sysconfig.get_platform().replace("-", "_").replace(".", "_")
        return _pack(wheel_directory, carried | _bundled(), licences, system)


def _pack(wheel_directory, taken, licences, system):
    info = f"artus-{PROJECT['version']}.dist-info"
    files = {name: file.read_bytes() for name, file in taken.items()}
    files |= {f"{info}/{name}": file.read_bytes() for name, file in licences.items()}
    files[f"{info}/licenses/LICENSE"] = (ROOT / "LICENSE").read_bytes()
    for name in ("__init__.py", "__init__.pyi", "__main__.py", "py.typed"):
        files[f"artus/{name}"] = (ROOT / "python" / "artus" / name).read_bytes()
    files[f"{info}/METADATA"] = _metadata().encode()
    files[f"{info}/WHEEL"] = (
        f"Wheel-Version: 1.0\nGenerator: artus\nRoot-Is-Purelib: false\nTag: {_tag(system)}\n").encode()
    record = "".join(f"{name},{_digest(data)}\n" for name, data in files.items())
    files[f"{info}/RECORD"] = (record + f"{info}/RECORD,,\n").encode()
    wheel = f"artus-{PROJECT['version']}-{_tag(system)}.whl"
    with zipfile.ZipFile(os.path.join(wheel_directory, wheel), "w", zipfile.ZIP_DEFLATED) as archive:
        for name, data in files.items():
            archive.writestr(name, data)
    return wheel
