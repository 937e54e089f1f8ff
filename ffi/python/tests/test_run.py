"""Scenes and models from arrays."""

import gc
import json
import pathlib
import signal
import threading
import time
import tracemalloc
import warnings

import brinell
import numpy as np
import pytest

SCENES = pathlib.Path(__file__).parents[3] / "data" / "scenes"
CYLINDER = SCENES / "cylinder_on_half_plane.toml"
SMALL = {"mesh.cylinder_on_half_plane.resolution": 4}
BLOCKS = SCENES / "hard" / "floating_body.toml"
FLOWS = {"materials.steel.yield_stress": 8.0, "materials.steel.plastic_modulus": 1000.0}


@pytest.fixture(scope="module")
def result():
    return brinell.run(CYLINDER, SMALL)


def test_tables_have_a_value_for_each_row(result):
    history = result.history
    n = len(history["alpha"])
    assert n > 3 and all(len(column) == n for column in history.values())
    assert list(history["increment"]) == list(range(1, n + 1))
    assert history["event"][-1].startswith("target")
    states = result.states
    assert states["name"] == [result[k].name for k in range(len(result))]
    quantities = [key for key in states if key != "name"]
    assert "residual_depth" in quantities and set(quantities) <= set(dir(result[0]))
    for key in quantities:
        assert np.array_equal(states[key], [getattr(state, key) for state in result], equal_nan=True), key
    assert isinstance(result[0].plastic_points, int) and isinstance(result[0].load, float)
    with pytest.raises(AttributeError, match="its quantities are"):
        result[0].depth
    assert result[-1].alpha == 0.0 and result["yield"].alpha == pytest.approx(1.0, rel=1e-9)
    with pytest.raises(IndexError):
        result[len(result)]
    with pytest.raises(brinell.InputError, match="nothing") as missing:
        result["nothing"]
    # Whoever takes it for a dictionary expects a KeyError, but not its quotes.
    assert isinstance(missing.value, KeyError) and missing.value.kind == "input"
    assert str(missing.value).startswith("there is no state")


def test_pandas_takes_the_tables(result):
    pandas = pytest.importorskip("pandas")
    frame = pandas.DataFrame(result.history)
    assert frame.shape == (len(result.history["alpha"]), len(result.history))
    assert pandas.DataFrame(result[1].pairs).closed.any()


def test_contact_balances_the_load(result):
    for state in (result[k] for k in range(len(result) - 1)):
        pairs = state.pairs
        # A half model: forces of the whole are twice those of its pairs.
        assert 2 * pairs["force"].sum() == pytest.approx(state.contact_force, rel=1e-12)
        assert state.contact_force == pytest.approx(state.load, rel=1e-9)
        assert pairs["pressure"].max() <= state.max_pressure * (1 + 1e-12)
        assert (pairs["force"][~pairs["closed"]] == 0).all()
        assert state.quality["equilibrium"] < 1e-8


def test_fields_belong_to_the_mesh(result):
    mesh, fields = result.mesh, result[0].fields
    n_nodes, n_elements = len(mesh["coordinates"]), len(mesh["element_body"])
    assert fields["displacement"].shape == (n_nodes, 2)
    assert fields["stress"].shape == (n_elements, 4)
    for name in ("von_mises", "plastic_strain", "yielded", "error"):
        assert fields[name].shape == (n_elements,)
    assert mesh["offsets"][-1] == len(mesh["connectivity"])
    assert mesh["connectivity"].max() == n_nodes - 1
    held = mesh["node_sets"]["half_plane.bottom"]
    assert (fields["displacement"][held, 1] == 0).all()


def test_everything_that_comes_out_is_a_view():
    result = brinell.run(CYLINDER, SMALL)

    def tables():
        state = result[0]
        return [result.history, state.pairs, state.fields, result.mesh]

    seen = 0
    for table, again in zip(tables(), tables()):
        for name, column in table.items():
            # Texts, statuses and sets of nodes are not stored as arrays.
            if not isinstance(column, np.ndarray) or name == "closed":
                continue
            assert np.shares_memory(column, again[name]) and not column.flags.owndata, name
            assert not column.flags.writeable, name
            seen += 1
    assert seen > 25
    # A view keeps alive what it shows.
    kept = [(column, column.copy()) for table in tables() for column in table.values() if isinstance(column, np.ndarray)]
    del result
    gc.collect()
    noise = [np.full(1000, np.nan) for _ in range(100)]
    assert all(np.array_equal(column, copy, equal_nan=True) for column, copy in kept) and len(noise) == 100


@pytest.mark.parametrize("width", [np.int32, np.int64])
def test_arrays_of_a_mesh_are_read_where_they_lie(width):
    n = 200
    x, y = np.meshgrid(np.arange(n + 1.0), np.arange(n + 1.0))
    coordinates = np.column_stack([x.ravel(), y.ravel()])
    corner = (np.arange(n)[:, None] * (n + 1) + np.arange(n)).ravel()
    nodes = np.column_stack([corner, corner + 1, corner + n + 2, corner + n + 1]).astype(width)
    model = brinell.Model()
    # numpy reports its memory to tracemalloc: a conversion would show there.
    tracemalloc.start()
    try:
        model.nodes(coordinates)
        model.elements("block", nodes)
        model.node_set("some", nodes[:, 0].copy())
        _, peak = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    assert (model.n_nodes, model.n_elements) == ((n + 1) ** 2, n**2)
    assert peak < 1.1 * nodes[:, 0].nbytes, peak


def test_the_summary_is_that_of_the_written_directory(result, tmp_path):
    result.write(tmp_path / "out")
    written = json.loads((tmp_path / "out" / "summary.json").read_text())
    summary = json.loads(json.dumps(result.summary))
    # The peak so far: writing takes memory too.
    assert written.pop("peak_memory_bytes") >= summary.pop("peak_memory_bytes") > 0
    assert written == summary
    assert (tmp_path / "out" / "report.html").exists()
    assert len(list((tmp_path / "out").glob("*.vtu"))) == len(result)


def test_overrides_come_in_every_form():
    text = BLOCKS.read_text()
    expected = brinell.run(BLOCKS, FLOWS)
    assert expected.history["plastic_points"].max() > 0
    for other in [
        brinell.run(str(BLOCKS), materials__steel__yield_stress=8, materials__steel__plastic_modulus=np.float64(1000)),
        brinell.run(text, FLOWS, program__targets=[{"load_factor": 1.0}, {"load_factor": 0.25}, {"load_factor": 1.0, "name": "again"}]),
        brinell.run(text, FLOWS, kind="plane_strain", solver=None),
    ]:
        assert (other.history["residual"] == expected.history["residual"]).all()
        assert other.states["name"] == expected.states["name"]


def test_a_table_is_merged_and_none_removes_a_key():
    targets = [{"load_factor": 1.0, "name": "pressed"}]
    # The unit stays that of the yield load.
    result = brinell.run(CYLINDER, {**SMALL, "program": {"targets": targets}})
    assert result["pressed"].load == pytest.approx(result.first_yield["load"], rel=1e-9)
    elastic = {"materials": {"steel": {"yield_stress": None, "plastic_modulus": None}}}
    removed = brinell.run(BLOCKS, {**FLOWS, **elastic})
    assert removed.history["plastic_points"].max() == 0
    with pytest.raises(brinell.InputError, match="no key `nonsense`"):
        brinell.run(BLOCKS, materials={"steel": {"nonsense": None}})
    with pytest.raises(brinell.InputError, match="None"):
        brinell.run(BLOCKS, program__targets=[None])


def test_a_key_that_a_list_loses_is_told():
    load = {"on": "upper.top", "pressure": 10.0, "name": "press"}
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        brinell.run(BLOCKS, load=[load])
    del load["name"]
    with pytest.warns(UserWarning, match="load.*no longer have `name`"):
        brinell.run(BLOCKS, load=[load])


def test_threads_are_an_argument():
    def tasks():
        return len(list(pathlib.Path("/proc/self/task").iterdir()))

    seen = []
    expected = brinell.run(CYLINDER, SMALL)
    before = tasks()
    # One thread more: that of the run itself, while the calling one looks for Ctrl-C.
    result = brinell.run(CYLINDER, SMALL, threads=3, callback=lambda row: seen.append(tasks()))
    assert max(seen) >= before + 3
    assert result.history["load"].tolist() == expected.history["load"].tolist()
    for wrong in (0, -1, 70000):
        with pytest.raises(brinell.InputError, match="threads is"):
            brinell.run(CYLINDER, SMALL, threads=wrong)

    def fail(row):
        raise KeyError(row["increment"])

    with pytest.raises(KeyError, match="1"):
        brinell.run(CYLINDER, SMALL, threads=2, callback=fail)


def test_an_estimate_comes_with_the_summary():
    result = brinell.run(CYLINDER, {"mesh.cylinder_on_half_plane.resolution": 8}, estimate=True)
    quantities = result.summary["accuracy"]["quantities"]
    assert any(q["quantity"] == "yield.load" and q["error"] > 0 for q in quantities)


def test_a_callback_sees_each_increment_and_stops():
    seen = []
    whole = brinell.run(CYLINDER, SMALL, callback=seen.append)
    assert [row["increment"] for row in seen] == list(whole.history["increment"])
    assert 0 <= seen[0]["fraction"] < seen[-1]["fraction"] <= 1
    part = brinell.run(CYLINDER, SMALL, callback=lambda row: row["increment"] == 2)
    assert part.incomplete and len(part.history["alpha"]) == 2
    assert (part.history["alpha"] == whole.history["alpha"][:2]).all()


def test_what_a_callback_raises_is_raised():
    def fail(row):
        raise KeyError(row["increment"])

    with pytest.raises(KeyError, match="1"):
        brinell.run(CYLINDER, SMALL, callback=fail)


@pytest.mark.skipif(not hasattr(signal, "setitimer"), reason="no timers on this system")
@pytest.mark.parametrize("threads", [None, 2])
def test_a_signal_stops_a_run(threads):
    class Pressed(Exception):
        pass

    def handle(number, frame):
        raise Pressed

    # As Ctrl-C: the signal arrives while the analysis works without the interpreter. The run would take several seconds.
    before = signal.signal(signal.SIGALRM, handle)
    begun = time.monotonic()
    try:
        signal.setitimer(signal.ITIMER_REAL, 0.3)
        with pytest.raises(Pressed):
            brinell.run(CYLINDER, {"mesh.cylinder_on_half_plane.resolution": 48}, threads=threads)
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0.0)
        signal.signal(signal.SIGALRM, before)
    assert time.monotonic() - begun < 60


def test_the_interpreter_is_free_while_a_run_works():
    # Each run waits in its callback for the other: with the interpreter held, neither would come.
    meet = threading.Barrier(2, timeout=120)
    results = []

    def work():
        first = []
        results.append(brinell.run(CYLINDER, SMALL, callback=lambda row: first or (first.append(row), meet.wait()) and None))

    threads = [threading.Thread(target=work) for _ in range(2)]
    for thread in threads:
        thread.start()
    begun = time.monotonic()
    ticks = 0
    while any(thread.is_alive() for thread in threads) and time.monotonic() - begun < 300:
        ticks += 1
        time.sleep(0.001)
    for thread in threads:
        thread.join()
    assert len(results) == 2 and ticks > 0
    assert (results[0].history["alpha"] == results[1].history["alpha"]).all()


def test_errors_have_a_kind_a_status_and_a_place(tmp_path):
    with pytest.raises(brinell.InputError, match="scene:1:.*kind") as caught:
        brinell.run("kind = 3\n")
    assert (caught.value.kind, caught.value.status, caught.value.result) == ("input", 2, None)
    with pytest.raises(brinell.IoError, match="nowhere") as caught:
        brinell.run(tmp_path / "nowhere.toml")
    assert caught.value.status == 3
    assert isinstance(caught.value, OSError) and "nowhere" in str(caught.value)
    with pytest.raises(brinell.UnsupportedError, match="friction"):
        brinell.run(BLOCKS.read_text() + "\n[friction]\n")
    with pytest.raises(brinell.InputError, match="--set"):
        brinell.run(BLOCKS, contact__0__gap=-1)


def test_collapse_hands_over_what_was_computed():
    with pytest.raises(brinell.CollapseError) as caught:
        brinell.run(SCENES / "hard" / "limit_load.toml")
    assert caught.value.status == 6
    assert caught.value.result.incomplete
    assert len(caught.value.result.history["alpha"]) > 0


def test_lost_accuracy_warns():
    loose = {"analysis__plastic_iteration": "plain", "analysis__tolerance": 0.0099}
    with pytest.warns(brinell.InaccurateWarning, match="equilibrium"):
        result = brinell.run(SCENES / "hard" / "unload_reload.toml", **loose)
    assert result.inaccurate
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        brinell.run(BLOCKS)


def test_a_demanded_accuracy_is_kept_or_warned_of():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        kept = brinell.run(SCENES / "thick_cylinder.toml", accuracy="5 %")
    assert kept.summary["accuracy"]["demand"]["reached"]
    with pytest.warns(brinell.InaccurateWarning, match="Demanded accuracy approach = 1 %: NOT reached"):
        missed = brinell.run(SCENES / "pin_in_hole.toml", accuracy="approach = 1 %")
    assert not missed.summary["accuracy"]["demand"]["reached"]
    with pytest.warns(brinell.InaccurateWarning, match="of the budget are left"):
        brinell.run(SCENES / "thick_cylinder.toml", accuracy="0.001 %", budget=0.5)


def model_of(result):
    """The scene of the two blocks by calls, on the arrays of the mesh of a run."""
    mesh = result.mesh
    model = brinell.Model("plane_strain")
    model.nodes(mesh["coordinates"])
    nodes = mesh["connectivity"].reshape(-1, 4)
    for body, name in enumerate(mesh["bodies"]):
        model.elements(name, nodes[mesh["element_body"] == body])
        model.body(name, "steel")
    sets = mesh["node_sets"]
    for name in ("upper.bottom", "lower.top", "lower.bottom", "upper.top"):
        model.surface_of_nodes(name, sets[name])
    model.node_set("left", np.concatenate([sets["lower.left"], sets["upper.left"]]))
    model.material("steel", youngs_modulus=210000.0, poissons_ratio=0.3, yield_stress=8, plastic_modulus=np.int64(1000))
    model.support("lower.bottom", "y")
    model.support("left", "x")
    model.target(load_factor=1.0)
    model.target(load_factor=0.25)
    model.target(load_factor=1.0, name="again")
    return model


def test_first_yield_is_a_target():
    expected = brinell.run(BLOCKS, FLOWS)
    model = model_of(expected)
    model.contact("upper.bottom", "lower.top")
    model.load("upper.top", pressure=10.0)
    model.target(first_yield=True, name="late")
    with pytest.raises(brinell.InputError, match="steel.*NaN"):
        model.material("other steel", youngs_modulus=float("nan"), poissons_ratio=0.3)
        model.run()
    model = model_of(expected)
    model.contact("upper.bottom", "lower.top")
    model.load("upper.top", pressure=10.0)
    model.target(first_yield=True, name="late")
    result = model.run()
    assert result["late"].alpha == pytest.approx(result.first_yield["alpha"], rel=1e-12)


def same(a, b):
    assert a.states["name"] == b.states["name"]
    for table, other in [(a.history, b.history)] + [(a[k].pairs, b[k].pairs) for k in range(len(a))]:
        for name in table:
            assert list(table[name]) == list(other[name]), name
    for k in range(len(a)):
        for name, field in a[k].fields.items():
            # Nodes in no pair have neither pressure nor gap: NaN.
            assert np.array_equal(field, b[k].fields[name], equal_nan=True), name


def test_a_model_from_arrays_is_the_scene_to_the_last_bit():
    expected = brinell.run(BLOCKS, FLOWS)
    assert expected[0].plastic_points > 0
    model = model_of(expected)
    model.contact("upper.bottom", "lower.top")
    model.load("upper.top", pressure=10.0)
    assert (model.n_nodes, model.n_elements) == (len(expected.mesh["coordinates"]), 64)
    same(model.run(), expected)
    # Once more: a run changes nothing.
    same(model.run(), expected)
    steps = model_of(expected)
    steps.contact("upper.bottom", "lower.top")
    steps.load("upper.top", pressure=10.0, name="press", history=[[0.0, 0.0], [1.0, 1.0]])
    steps.program(stepping="steps", steps=3)
    steps.settings(plastic_iteration="anderson", tolerance=1e-11)
    other = steps.run()
    # Three steps to each target, and one more that ends at first yield.
    assert other.history["alpha"][-6:].tolist() == pytest.approx([0.75, 0.5, 0.25, 0.5, 0.75, 1.0], rel=1e-14)
    assert len(other.history["alpha"]) == 10
    # From first yield to the full load events take one increment, fixed steps two: each has an error of its path (three hundred
    # steps give 0.0011465, one increment 0.17 % more).
    assert other[2].residual_depth == pytest.approx(expected[2].residual_depth, rel=3e-3)


def test_given_pairs_and_nodal_forces():
    mesh = brinell.run(BLOCKS, FLOWS)
    x = mesh.mesh["coordinates"][:, 0]
    lower, upper = (mesh.mesh["node_sets"][name] for name in ("lower.top", "upper.bottom"))
    top = mesh.mesh["node_sets"]["upper.top"]
    width = np.where((x[top] == 0) | (x[top] == 2), 0.125, 0.25)
    model = model_of(mesh)
    pairs = np.column_stack([upper[np.argsort(x[upper])], lower[np.argsort(x[lower])]])
    model.contact("upper.bottom", "lower.top", pairs=pairs, gap=np.full(9, 0.01), normal=(0, 1))
    model.nodal_load("push", top, np.column_stack([0 * width, -10.0 * width]), history="proportional")
    result = model.run()
    # The gap is closed by moving the upper block: 0.01 or the distance in the mesh differ by round-off.
    for k in range(len(result)):
        assert result[k].contact_force == pytest.approx(mesh[k].contact_force, rel=1e-12)
        assert result[k].pairs["force"] == pytest.approx(mesh[k].pairs["force"], rel=1e-6)


@pytest.mark.parametrize(
    "act, words",
    [
        (lambda m: m.nodes([[0.0, np.nan]]), "node 4: coordinate y is NaN"),
        (lambda m: m.nodes([0.0, 1.0]), "shape"),
        (lambda m: m.elements("a", [[0, 1, 2]]), "shape"),
        (lambda m: m.elements("a", [[0, 1, 2, 9]]), "element 1 .*node 3 is 9"),
        (lambda m: m.elements("a", [[0, 1, 2, -9]]), "node 3 is -9"),
        (lambda m: m.elements("a", [[0, 1, 2, 3.5]]), "whole numbers"),
        (lambda m: m.elements("a", [[0, 1, 2, 3]], shape="hex8"), "hex8"),
        (lambda m: m.node_set("s", [4]), "node 4"),
        (lambda m: m.surface("s", [[0, 4]]), "facet 4"),
        (lambda m: m.surface_of_nodes("s", [0, 2]), "node 0"),
        (lambda m: m.material("steel", youngs_modulus=1.0, poisons_ratio=0.3), "poisons_ratio"),
        (lambda m: m.material("steel", youngs_modulus="much", poissons_ratio=0.3), "steel"),
        (lambda m: m.contact("a", "b", pairs=[[0, 0]]), "pair 0: node 0"),
        (lambda m: m.contact("a", "b", pairs=[[0, 1]], gap=[1.0, 2.0]), "2 gaps"),
        (lambda m: m.contact("a", "b", pairs=[[0, 1]], gap=-1.0), "gap is -1"),
        (lambda m: m.contact("a", "b", pairs=[[0, 1]], normal=[[0.0, 0.0]]), "no direction"),
        (lambda m: m.support("a", "z"), "'z'"),
        (lambda m: m.load("a", presure=1.0), "presure"),
        (lambda m: m.nodal_load("push", [0, 1], [[1.0, 0.0]]), "2 nodes have 1 forces"),
        (lambda m: m.target(load_facter=1.0), "load_facter"),
        (lambda m: m.program(unit="bar"), "bar"),
        (lambda m: m.run(), "bodies"),
    ],
)
def test_bad_arrays_are_refused_by_index(act, words):
    model = brinell.Model()
    model.nodes([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
    model.elements("a", [[0, 1, 2, 3]])
    with pytest.raises(brinell.InputError, match=words):
        act(model)
    assert (model.n_nodes, model.n_elements) == (4, 1)


def test_a_body_that_nothing_holds_is_named():
    expected = brinell.run(BLOCKS, FLOWS)
    model = model_of(expected)
    model.load("upper.top", pressure=10.0)
    with pytest.raises(brinell.UnheldError, match="upper") as caught:
        model.run()
    assert (caught.value.kind, caught.value.status) == ("unheld", 4)


def test_a_solid_from_arrays_passes_its_load_on():
    """Two cubes pressed together along z: the pressure is the load over the area."""
    model = brinell.Model("solid")
    cube = np.array([[x, y, z] for z in (0, 1) for y in (0, 1) for x in (0, 1)], float)
    hexahedron = np.array([[0, 1, 3, 2, 4, 5, 7, 6]])
    for k, body in enumerate(["lower", "upper"]):
        model.nodes(cube + [0, 0, k])
        model.elements(body, hexahedron + 8 * k, shape="hex8")
        model.body(body, "steel")
    model.material("steel", youngs_modulus=1000.0, poissons_ratio=0.3)
    model.surface_of_nodes("below", np.array([4, 5, 6, 7]))
    model.surface_of_nodes("above", np.array([8, 9, 10, 11]))
    model.surface_of_nodes("top", np.array([12, 13, 14, 15]))
    model.node_set("floor", np.arange(4))
    model.node_set("x0", np.arange(0, 16, 2))
    model.node_set("y0", np.array([0, 1, 4, 5, 8, 9, 12, 13]))
    model.support("floor", "z")
    model.support("x0", "x")
    model.support("y0", direction=[0.0, 1.0, 0.0])
    model.contact("above", "below", normal=[0.0, 0.0, 1.0])
    model.load("top", force=[0.0, 0.0, -10.0])
    model.target(load_factor=1.0)
    result = model.run()
    state = result[0]
    assert state.pairs["pressure"] == pytest.approx(10.0, rel=1e-12)
    assert (state.pairs["z"] == 1.0).all()
    assert state.fields["stress"].shape == (2, 6)
    assert state.fields["stress"][:, 2] == pytest.approx(-10.0, rel=1e-12)
    assert state.fields["displacement"].shape == (16, 3)
    with pytest.raises(brinell.InputError, match="hex8"):
        model.elements("lower", hexahedron, shape="quad4")


def test_scene_text_beside_arrays_says_all_that_a_scene_may():
    """A cube between two walls that is heated: the stress is -E alpha dT."""
    model = brinell.Model("solid")
    cube = np.array([[x, y, z] for z in (0, 1) for y in (0, 1) for x in (0, 1)], float)
    model.nodes(cube)
    model.elements("cube", np.array([[0, 1, 3, 2, 4, 5, 7, 6]]), shape="hex8")
    for name, nodes in [("x0", [0, 2, 4, 6]), ("y0", [0, 1, 4, 5]), ("ends", [0, 1, 2, 3, 4, 5, 6, 7])]:
        model.node_set(name, np.array(nodes))
    model.tables("""
        materials.steel = { youngs_modulus = 200e3, poissons_ratio = 0.3, thermal_expansion = 1e-5 }
        bodies.cube = { material = "steel" }
        support = [{ on = "x0", fix = ["x"] }, { on = "y0", fix = ["y"] }, { on = "ends", fix = ["z"] }]
        load = [{ on = "cube", temperature = "20 + 0*x" }]
        program.targets = [{ load_factor = 2.0, name = "hot" }]
    """)
    state = model.run()["hot"]
    assert state.fields["stress"][0, 2] == pytest.approx(-200e3 * 1e-5 * 40.0, rel=1e-12)
    with pytest.raises(brinell.InputError, match="(?s)line 1.*colour"):
        model.tables("colour = 1")


def test_a_plastic_history_of_a_solid_from_arrays_is_the_scene_s():
    sets = {"mesh.curved_bodies.resolution": 2, "mesh.curved_bodies.contact_width": 2.5, "mesh.curved_bodies.far_size": 10}
    expected = brinell.run(SCENES / "ball_on_flat_3d.toml", sets)
    mesh = expected.mesh
    model = brinell.Model("solid", symmetry=4)
    model.nodes(mesh["coordinates"])
    nodes = mesh["connectivity"].reshape(-1, 8)
    model.material("steel", youngs_modulus=210000.0, poissons_ratio=0.3, yield_stress=500.0, tangent_modulus=2100.0)
    for body, name in enumerate(mesh["bodies"]):
        model.elements(name, nodes[mesh["element_body"] == body], shape="hex8")
        model.body(name, "steel")
    sets = mesh["node_sets"]
    for name in ("upper.contact", "lower.contact", "upper.top"):
        model.surface_of_nodes(name, sets[name])
    for name, axis in [("symmetry_x", "x"), ("symmetry_y", "y")]:
        for body in ("upper", "lower"):
            model.node_set(f"{body}.{name}", sets[f"{body}.{name}"])
            model.support(f"{body}.{name}", axis)
    model.node_set("lower.bottom", sets["lower.bottom"])
    model.support("lower.bottom", "z")
    model.contact("upper.contact", "lower.contact")
    model.load("upper.top", plane_force={"direction": "z", "total": -1000.0}, name="press")
    model.program(unit="yield")
    model.target(first_yield=True)
    for factor in (1.5, 2.0, 3.0):
        model.target(load_factor=factor)
    model.target(load_factor=0.0, name="unloaded")
    same(model.run(), expected)
    assert expected[3].plastic_points > 0 and expected[4].residual_depth > 0
    (patch,) = expected[3].patches
    assert patch["force"] == pytest.approx(expected[3].contact_force, rel=1e-9)
    assert patch["semi_axes"][0] == pytest.approx(patch["semi_axes"][1], rel=1e-6)
    assert expected[4].patches == []


def test_a_new_scene_runs_and_is_written_once(tmp_path):
    text = brinell.new("ball-on-flat", radius=5, yield_stress=500, plastic_modulus=2000, load=20, resolution=4)
    assert "# Made by `brinell new`" in text
    result = brinell.run(text)
    assert result["pressed"].load == pytest.approx(20, rel=1e-9)
    out = tmp_path / "ball.toml"
    assert brinell.new("ball-on-flat", load=20, three_dimensional=True, out=out) == out.read_text()
    with pytest.raises(brinell.IoError, match="exists"):
        brinell.new("ball-on-flat", load=20, out=out)
    with pytest.raises(brinell.InputError, match="ball-on-flat"):
        brinell.new("ball-on-flt")
    with pytest.raises(brinell.InputError, match="--radius"):
        brinell.new("ball-on-flat", radius=-5)


def test_a_rigid_surface_is_followed():
    result = brinell.run(SCENES / "hard" / "rigid_ball.toml")
    history = result.history
    assert result["unloaded"].residual_depth > 0.0
    pushed = -history["ball.force_y"]
    assert np.allclose(pushed, history["contact_1.force"], rtol=0.0, atol=5e-3 * max(pushed))
    assert np.allclose(history["contact_1.approach"], history["approach"], rtol=1e-9, atol=1e-15)
    assert np.allclose(-history["ball.displacement_y"], history["approach"], rtol=1e-9, atol=1e-15)
