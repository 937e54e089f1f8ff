"""What helps to look at results, and to know before a run."""

import pathlib

import brinell
import numpy as np
import pytest

SCENES = pathlib.Path(__file__).parents[3] / "data" / "scenes"
CYLINDER = SCENES / "cylinder_on_half_plane.toml"
SMALL = {"mesh.cylinder_on_half_plane.resolution": 4}


@pytest.fixture(scope="module")
def result():
    return brinell.run(CYLINDER, SMALL)


def test_check_and_yield_load_are_those_of_the_run(result):
    known = brinell.check(CYLINDER, SMALL)
    for key in ("nodes", "elements", "freedoms", "contact_pairs"):
        assert known["sizes"][key] == result.summary[key]
    assert known["predicted_run_seconds"] > 0
    first = brinell.yield_load(CYLINDER, SMALL)
    assert first["load"] == pytest.approx(result.first_yield["load"], rel=1e-9)
    with pytest.raises(brinell.AnalysisError, match="no body that may yield"):
        brinell.yield_load(SCENES / "contact_patch.toml")
    with pytest.raises(brinell.InputError, match="did you mean"):
        brinell.check(CYLINDER, {"mesh.cylinder_on_half_plane.radiu": 1.0})
    with pytest.raises(OSError, match="absent.toml"):
        brinell.check("absent.toml")


def test_a_result_names_its_units(result):
    assert result.units == {"length": "mm", "force": "N", "stress": "MPa", "load": "N/mm"}
    assert result.label("max_pressure") == "max pressure [MPa]"
    assert result.label("increment") == "increment"
    table = result._repr_html_()
    assert "max pressure [MPa]" in table and table.count("<tr>") == 1 + len(result)
    assert f"<th>{result[0].name}</th>" in table


def test_fields_have_the_names_of_the_files(result):
    fields = result[1].fields
    assert np.array_equal(fields["equivalent_plastic_strain"], fields["plastic_strain"])
    assert np.array_equal(fields["discretisation_error"], fields["error"])


def test_meshio_takes_a_state(result, tmp_path):
    meshio = pytest.importorskip("meshio")
    mesh = result.to_meshio(1)
    state = result[1]
    assert len(mesh.points) == len(result.mesh["coordinates"])
    assert sum(len(block.data) for block in mesh.cells) == len(result.mesh["shapes"])
    mesh.write(tmp_path / "state.vtu")
    again = meshio.read(tmp_path / "state.vtu")
    assert np.array_equal(again.cell_data["von_mises"][0], state.fields["von_mises"])
    assert np.array_equal(again.point_data["displacement"][:, :2], state.fields["displacement"])
    # The file that brinell writes has the same.
    result.write(tmp_path / "out")
    written = meshio.read(sorted((tmp_path / "out").glob("state_02*.vtu"))[0])
    assert set(written.cell_data) == set(again.cell_data)
    # One component is a column there.
    of_file = written.cell_data["von_mises"][0].ravel()
    assert np.array_equal(of_file, again.cell_data["von_mises"][0])
    assert [block.type for block in written.cells] == [block.type for block in again.cells]
    assert np.array_equal(written.cells[0].data, again.cells[0].data)


def test_a_plot_has_words_and_units(result):
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    axes = result.plot()
    assert axes.get_ylabel() == "max pressure [MPa]" and axes.get_xlabel() == "load [N/mm]"
    assert np.array_equal(axes.lines[0].get_ydata(), result.history["max_pressure"])
    with pytest.raises(brinell.InputError, match="its columns are"):
        result.plot("depth")
