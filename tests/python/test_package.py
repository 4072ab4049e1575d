# SPDX-License-Identifier: AGPL-3.0-or-later
"""The module as a package: import, stub, program, document, installation."""

import ast
import inspect
import re
import subprocess
import sys

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


def test_the_documents_example_runs(source, simple, tmp_path, monkeypatch):
    blocks = re.findall(r"```python\n(.*?)```", (source / "docs/python.md").read_text(), re.S)
    assert blocks
    monkeypatch.chdir(tmp_path)
    code = blocks[0].replace("meshes/simple-shoulder", str(simple))
    exec(compile(code, "docs/python.md", "exec"), {"__name__": "example"})
    assert (tmp_path / "view.pgm").stat().st_size > 1000


def test_pip_installs_without_network(source, tmp_path):
    """A wheel of the tree that is built, into a folder of its own."""
    from pathlib import Path

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
