# SPDX-License-Identifier: AGPL-3.0-or-later
"""The module as a package: import, stub, program, document, installation."""

import ast
import importlib.util
import inspect
import re
import shutil
import subprocess
import sys
import types
import zipfile
from pathlib import Path

import pytest

import artus
from tooling import run


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


def document_parts(source, simple):
    """The three programs of docs/python.md: the first one, PyTorch's, the classifier."""
    parts = re.findall(r"```python\n(.*?)```", (source / "docs/python.md").read_text(), re.S)
    assert len(parts) == 3
    return [part.replace("meshes/simple-shoulder", str(simple)) for part in parts]


def torch_stand_in():
    """As much of PyTorch as the document uses, where it is not there: it cannot batch or start workers."""
    data = types.SimpleNamespace(IterableDataset=object, get_worker_info=lambda: None,
                                 DataLoader=lambda items, **how: items)
    return types.SimpleNamespace(utils=types.SimpleNamespace(data=data))


def test_the_documents_example_runs(source, simple, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    first, torch, _ = document_parts(source, simple)
    names = {"__name__": "example"}
    exec(compile(first, "docs/python.md", "exec"), names)
    assert (tmp_path / "view.pgm").stat().st_size > 1000
    said = capsys.readouterr().out
    assert "mm from the target" in said and "None" not in said
    if importlib.util.find_spec("torch") is None:
        monkeypatch.setitem(sys.modules, "torch", torch_stand_in())
    exec(compile(torch, "docs/python.md", "exec"), names)
    assert [item["index"] for item in names["Views"]()] == list(range(len(names["poses"])))


def test_the_documents_classifier_learns_where_needles_are(source, simple, tmp_path):
    pytest.importorskip("sklearn", reason="python3-sklearn is not there")
    (tmp_path / "learn.py").write_text(document_parts(source, simple)[2])
    # one thread: on a machine with other work the learner's threads wait for each other
    out = run("env", "OMP_NUM_THREADS=1", sys.executable, tmp_path / "learn.py")
    assert float(re.search(r"balanced accuracy ([0-9.]+)", out).group(1)) > 0.85


def test_import_is_quick():
    # by the processor's time, which others on the machine do not lengthen
    code = ("import numpy, time; t = time.process_time(); import artus; "
            "print(time.process_time() - t)")
    assert min(float(run(sys.executable, "-c", code)) for _ in range(3)) < 0.3


def test_pip_installs_without_network(source, tmp_path):
    """A wheel of the tree that is built, into a folder of its own."""
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


def test_a_wheel_carries_what_it_needs(source, bundled_cache, tmp_path):
    """Taken apart, it loads nothing but its own libraries and those that every system has, and finds its joints."""
    if shutil.which("patchelf") is None:
        pytest.skip("patchelf is not there")
    build = Path(artus.__file__).resolve().parents[2]
    code = ("import sys; sys.path.insert(0, 'python'); import build_backend; print(build_backend.build_wheel("
            f"{str(tmp_path)!r}, {{'build-dir': {str(build)!r}, 'carry': 'yes'}}))")
    done = subprocess.run([sys.executable, "-c", code], cwd=source, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    name = done.stdout.split()[-1]
    assert re.fullmatch(r"artus-[0-9.]+-(cp3[0-9]+)-\1-manylinux_2_[0-9]+_[a-z0-9_]+\.whl", name)
    with zipfile.ZipFile(tmp_path / name) as wheel:
        wheel.extractall(tmp_path / "site")
        assert any("licenses/libembree" in member for member in wheel.namelist())
    out = run("env", f"PYTHONPATH={tmp_path / 'site'}", sys.executable, "-c",
              f"import artus; print(artus.__file__); artus.load('simple-shoulder', cache={str(bundled_cache)!r}); "
              "print(open('/proc/self/maps').read())")
    assert out.startswith(str(tmp_path))
    loaded = set(re.findall(r"/\S+/(lib(?:embree|tbb|gmp|mpfr|tet|toml)\S*)", out))
    assert loaded and all(re.search(r"-[0-9a-f]{8}\.so", library) for library in loaded), loaded
