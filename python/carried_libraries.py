# SPDX-License-Identifier: AGPL-3.0-or-later
"""Makes a module carry the libraries that it needs: copies under names of their own beside it, their licences,
and the name of the systems on which it then runs. Needs patchelf and binutils (scripts/setup).
"""

import hashlib
import os
import platform
import re
import shutil
import subprocess
from pathlib import Path

# What every Linux with a C++ program has (PEP 600): these are asked of the system.
SYSTEM = re.compile(r"(lib(c|m|dl|rt|pthread|util|stdc\+\+|gcc_s)|ld-linux.*)\.so\.[0-9]+$|linux-vdso")


def _said(*command):
    return subprocess.run([str(c) for c in command], check=True, capture_output=True, text=True).stdout


def _needed(file):
    """{name: path} of all that a file loads and no system has by itself."""
    found = {}
    for line in _said("ldd", file).splitlines():
        name = Path(line.split()[0]).name
        if SYSTEM.match(name):
            continue
        path = re.search(r"=> (/\S+)", line)
        if path is None:
            raise RuntimeError(f"{file} needs {name}, which is not there")
        found[name] = Path(path.group(1)).resolve()
    return found


def _own_name(name, path):
    digest = hashlib.sha256(path.read_bytes()).hexdigest()[:8]
    stem, rest = name.split(".so", 1)
    return f"{stem}-{digest}.so{rest}"


def _licence_of(path):
    """(package, file) of what the system's package says of its licence."""
    for name in (path, str(path).replace("/usr/lib/", "/lib/", 1)):
        done = subprocess.run(["dpkg-query", "-S", str(name)], capture_output=True, text=True)
        if done.returncode == 0:
            package = done.stdout.split(":")[0]
            return package, Path("/usr/share/doc") / package / "copyright"
    raise RuntimeError(f"no package of this system owns {path}: its licence is not known")


def _newest_glibc(files):
    newest = (2, 17)
    for file in files:
        for major, minor in re.findall(r"\bGLIBC_([0-9]+)\.([0-9]+)", _said("objdump", "-T", file)):
            newest = max(newest, (int(major), int(minor)))
    return newest


def carry(module, folder):
    """Copies `module` into `folder` with all it needs in `folder`/lib: ({path in the wheel: file}, {licence's
    name: file}, platform's tag).

    The tag names the C library of the system that it was built on: C++'s of the same age comes with that.
    """
    for program in ("patchelf", "objdump", "strip"):
        if shutil.which(program) is None:
            raise RuntimeError(f"{program} is not there (scripts/setup)")
    needed = _needed(module)
    names = {name: _own_name(name, path) for name, path in needed.items()}
    (folder / "lib").mkdir(parents=True)
    copies = {module.name: folder / module.name}
    shutil.copy(module, copies[module.name])
    copies |= {name: folder / "lib" / names[name] for name in names}
    for name, path in needed.items():
        shutil.copy(path, copies[name])
    for name, copy in copies.items():
        copy.chmod(0o755)
        subprocess.run(["strip", "--strip-unneeded", str(copy)], check=True)
        # one change a run: patchelf takes the last value for all of them
        changes = [["--set-rpath", "$ORIGIN" if name in names else "$ORIGIN/lib"]]
        if name in names:
            changes.append(["--set-soname", names[name]])
        for old in _said("patchelf", "--print-needed", copy).split():
            if old in names:
                changes.append(["--replace-needed", old, names[old]])
        for change in changes:
            subprocess.run(["patchelf", *change, str(copy)], check=True)
    for name, path in _needed(copies[module.name]).items():
        if folder.resolve() not in path.parents:
            raise RuntimeError(f"the module still takes {name} from {path}")
    files = {f"artus/{copy.relative_to(folder)}": copy for copy in copies.values()}
    licences = {}
    for path in needed.values():
        package, file = _licence_of(path)
        licences[f"licenses/{package}"] = file
    built_on = tuple(map(int, os.confstr("CS_GNU_LIBC_VERSION").split()[1].split(".")))
    if _newest_glibc(copies.values()) > built_on:
        raise RuntimeError("a library asks for a newer C library than this system has")
    return files, licences, f"manylinux_{built_on[0]}_{built_on[1]}_{platform.machine()}"
