"""The Python that the pages show runs."""

import pathlib
import re

import brinell
import pytest

ROOT = pathlib.Path(__file__).parents[3]


def blocks(page, language):
    text = (ROOT / page).read_text(encoding="utf-8")
    return re.findall(rf"```{language}\n(.*?)```", text, re.DOTALL)


def test_the_readme_runs_its_own_scene(tmp_path, monkeypatch):
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    monkeypatch.chdir(tmp_path)
    (tmp_path / "ball.toml").write_text(blocks("README.md", "toml")[0], encoding="utf-8")
    names = {}
    exec(blocks("ffi/README.md", "python")[0], names)
    assert names["result"]["off"].residual_depth > 0


def test_the_sweep_of_the_guide(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    brinell.new("ball-on-flat", load=20, resolution=4, out="ball.toml")
    exec(blocks("data/guide/sweep.md", "python")[0], {})
    lines = [line.split() for line in capsys.readouterr().out.splitlines()]
    depths = [float(depth) for _, depth in lines]
    assert [stress for stress, _ in lines] == ["400", "500", "600"]
    assert depths == sorted(depths, reverse=True)


def test_the_fields_of_the_paraview_page(tmp_path, monkeypatch):
    pyvista = pytest.importorskip("pyvista")
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(pyvista.DataSet, "plot", lambda mesh, **how: mesh)
    text = brinell.new("ball-on-flat", load=20, resolution=4)
    brinell.run(text).write("ball.out")
    exec(blocks("data/guide/paraview.md", "python")[0], {})
