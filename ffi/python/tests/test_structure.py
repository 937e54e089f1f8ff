"""The lower level against scipy's solves of the same small problem."""

import gc
import pathlib
import subprocess
import sys
import tracemalloc

import brinell
import numpy as np
import pytest
import scipy.optimize
import scipy.sparse
import scipy.sparse.linalg


def chain(n):
    """Springs of different stiffness in a row, the first tied to the ground."""
    k = 1.0 + 0.5 * np.sin(np.arange(n))
    next_one = np.append(k[1:], 0.0)
    return scipy.sparse.diags([-k[1:], k + next_one, -k[1:]], [-1, 0, 1], format="csc")


def plate(n):
    """A membrane of n x n nodes, held at its border: five-point stencil."""
    one = scipy.sparse.diags([-np.ones(n - 1), 2 * np.ones(n), -np.ones(n - 1)], [-1, 0, 1])
    eye = scipy.sparse.identity(n)
    return (scipy.sparse.kron(one, eye) + scipy.sparse.kron(eye, one)).tocsc()


def scipy_contact(k, rows, gaps, load):
    """Displacements, gaps and forces by non-negative least squares on the dual: min |L' r + L^-1 q|, the Cholesky factor L of
    B K^-1 B'."""
    flexibility = scipy.sparse.linalg.spsolve(k, rows.T.toarray()).reshape(k.shape[0], -1)
    free = scipy.sparse.linalg.spsolve(k, load)
    a = rows @ flexibility
    factor = np.linalg.cholesky(0.5 * (a + a.T))
    forces, _ = scipy.optimize.nnls(factor.T, np.linalg.solve(factor, rows @ free - gaps))
    u = free - flexibility @ forces
    return u, gaps - rows @ u, forces


def obstacle(n=12):
    """A membrane over an obstacle: a row for each node of the middle lines."""
    k = plate(n)
    touched = np.arange(n * n).reshape(n, n)[n // 2 - 1 : n // 2 + 2].ravel()
    rows = scipy.sparse.csr_matrix((np.ones(touched.size), (np.arange(touched.size), touched)), shape=(touched.size, n * n))
    rng = np.random.default_rng(7)
    gaps = 0.2 + 0.8 * rng.random(touched.size)
    load = 0.1 * (0.5 + rng.random(n * n))
    return k, rows, gaps, load


def close(a, b, scale):
    # Two solves of well-conditioned systems (condition below 1e4): round-off 2e-16 times it, with room for the sums.
    assert np.max(np.abs(a - b)) <= 1e-11 * scale, np.max(np.abs(a - b)) / scale


def test_contact_under_a_load_is_that_of_scipy():
    k, rows, gaps, load = obstacle()
    structure = brinell.Structure(k, rows, gaps)
    assert (structure.n_freedoms, structure.n_rows) == (144, 36)
    structure.solve(load)
    u, gap, force = scipy_contact(k, rows, gaps, load)
    assert 3 < np.count_nonzero(force) < 33, "the case must have open and closed rows"
    close(structure.displacements(), u, np.abs(u).max())
    close(structure.gaps, gap, np.abs(u).max())
    close(structure.forces, force, force.max())
    assert (structure.closed == (force > 0)).all()
    assert structure.backward_error < 1e-14


def test_condensed_stiffness_is_the_schur_complement():
    k, rows, gaps, _ = obstacle()
    structure = brinell.Structure(k, rows, gaps)
    c = structure.contact_freedoms
    assert (c == np.unique(rows.indices)).all()
    inside = np.setdiff1d(np.arange(k.shape[0]), c)
    inner = scipy.sparse.linalg.spsolve(k[inside][:, inside].tocsc(), k[inside][:, c].toarray())
    schur = k[c][:, c].toarray() - k[c][:, inside] @ inner
    close(structure.condensed_stiffness, schur, np.abs(schur).max())


def test_events_lead_to_the_state_that_one_solve_finds():
    k, rows, gaps, load = obstacle()
    path = brinell.Structure(k, rows, gaps)
    path.start(load)
    events = []
    while True:
        t, changes = path.step(1.0)
        if not changes:
            break
        events.append(t)
        for row, closes in changes:
            # At its event a row has neither a gap nor a force.
            assert abs(path.gaps[row]) < 1e-12 and abs(path.forces[row]) < 1e-12
            assert closes in (True, False)
    assert t == 1.0 and len(events) > 3 and events == sorted(events)
    u, gap, force = scipy_contact(k, rows, gaps, load)
    close(path.displacements(), u, np.abs(u).max())
    close(path.forces, force, force.max())


def test_all_ways_to_hand_over_a_matrix_mean_the_same():
    k, n = chain(20), 20
    rows = scipy.sparse.csr_matrix(([1.0, 1.0, -1.0], ([0, 1, 1], [19, 10, 4])), shape=(2, n))
    load = np.linspace(0.0, 1.0, n)
    found = []
    for stiffness, triangle in [
        (k, "both"),
        (scipy.sparse.triu(k), "upper"),
        (scipy.sparse.tril(k).tocoo(), "lower"),
        ((k.data, k.indices.astype(np.int32), k.indptr.tolist()), "both"),
    ]:
        for b in [rows, (rows.data, rows.indices, rows.indptr), rows.toarray(), rows.toarray().tolist()]:
            structure = brinell.Structure(stiffness, b, [0.5, 0.25], triangle=triangle)
            structure.solve(load)
            found.append(structure.displacements())
    assert all((u == found[0]).all() for u in found)
    assert structure.closed.any()
    out = np.empty(n)
    assert structure.displacements(out) is out
    assert (out == found[0]).all()


def test_without_rows_it_is_a_plain_solve():
    k = plate(9)
    load = np.random.default_rng(1).random(81)
    structure = brinell.Structure(k, solver="dense")
    structure.solve(load)
    u = scipy.sparse.linalg.spsolve(k, load)
    close(structure.displacements(), u, np.abs(u).max())


def test_a_body_held_by_contact_alone():
    # Two masses on a spring between walls at 1 and -2 of each: K is singular.
    k = scipy.sparse.csc_matrix([[3.0, -3.0], [-3.0, 3.0]])
    structure = brinell.Structure(k, [[0.0, 1.0], [-1.0, 0.0]], [1.0, 2.0])
    structure.solve([6.0, 0.0])
    assert structure.forces.tolist() == pytest.approx([6.0, 0.0], abs=1e-14)
    assert structure.displacements().tolist() == pytest.approx([3.0, 1.0], rel=1e-14)
    with pytest.raises(brinell.UnheldError) as caught:
        brinell.Structure(k)
    assert caught.value.kind == "unheld" and caught.value.status == 4


@pytest.mark.parametrize(
    "arguments, words",
    [
        (dict(stiffness=([1.0], [3], [0, 1])), "row of the matrix, 3"),
        (dict(stiffness=([1.0, 2.0], [0, 0], [0, 1])), "starts of 1 columns"),
        (dict(stiffness=([np.nan], [0], [0, 1])), "NaN"),
        (dict(stiffness=([1.0], [0.5], [0, 1])), "whole numbers"),
        (dict(stiffness=([1.0], [0])), "2 arrays"),
        (dict(stiffness=7), "scipy sparse"),
        (dict(stiffness=scipy.sparse.csc_matrix(np.ones((2, 3)))), "not square"),
        (dict(rows=[[1.0, 0.0, 0.0]], gaps=[1.0]), "3 columns"),
        (dict(rows=[[1.0, 0.0]], gaps=[]), "1 contact rows have 0 gaps"),
        (dict(rows=[[1.0, 0.0]], gaps=[np.inf]), "not finite"),
        (dict(rows=[[1.0, 0.0], [1.0, 0.0]], gaps=[1.0, 1.0]), "depend on each other"),
        (dict(triangle="middle"), "middle"),
        (dict(solver="magic"), "magic"),
    ],
)
def test_bad_arrays_are_refused(arguments, words):
    with pytest.raises(brinell.InputError, match=words) as caught:
        brinell.Structure(**{"stiffness": scipy.sparse.identity(2, format="csc"), **arguments})
    assert isinstance(caught.value, ValueError)
    assert (caught.value.kind, caught.value.status) == ("input", 2)


def test_bad_loads_are_refused_and_change_nothing():
    structure = brinell.Structure(chain(3), [[0.0, 0.0, 1.0]], [10.0])
    structure.solve([0.0, 0.0, 1.0])
    before = structure.displacements()
    for load, words in [([1.0], "1 values"), ([0.0, np.nan, 0.0], "freedom 1 is NaN"), ("x", "no array")]:
        with pytest.raises(brinell.InputError, match=words):
            structure.solve(load)
    with pytest.raises(brinell.InputError, match="no piece"):
        structure.step(1.0)
    with pytest.raises(brinell.InputError, match="2 values"):
        structure.displacements(np.empty(2))
    assert (structure.displacements() == before).all()


def address(array):
    return array.__array_interface__["data"][0]


def test_results_are_views_of_their_state_and_outlive_the_structure():
    k, rows, gaps, load = obstacle()
    structure = brinell.Structure(k, rows, gaps)
    structure.solve(load)
    for name in ("gaps", "forces", "condensed_stiffness"):
        view = getattr(structure, name)
        assert not view.flags.owndata and not view.flags.writeable, name
        assert address(view) == address(getattr(structure, name)) and np.shares_memory(view, getattr(structure, name))
        with pytest.raises(ValueError):
            view[0] = 1.0
    first = structure.gaps, structure.forces
    then = [view.copy() for view in first]
    # A view is of its own state: that of another lies elsewhere, whether it is found at once or along a path.
    structure.solve(2 * load)
    structure.start(load)
    between = structure.gaps
    at = between.copy()
    structure.step(1.0)
    assert address(structure.gaps) not in (address(first[0]), address(between))
    condensed = structure.condensed_stiffness
    expected = condensed.copy()
    del structure
    gc.collect()
    noise = [np.full(gaps.size, np.nan) for _ in range(100)]
    assert all((view == old).all() for view, old in zip(first, then)) and (between == at).all()
    assert (condensed == expected).all() and len(noise) == 100


@pytest.mark.parametrize("width", [np.int32, np.int64])
@pytest.mark.parametrize("triangle", ["both", "upper", "lower"])
def test_every_layout_of_a_matrix_is_the_same_matrix(width, triangle):
    k, rows, gaps, load = obstacle()
    part = {"both": k, "upper": scipy.sparse.triu(k, format="csc"), "lower": scipy.sparse.tril(k, format="csc")}[triangle]
    data, indices, indptr = part.data, part.indices.astype(width), part.indptr.astype(width)
    # Columns backwards, and each entry in two parts.
    backwards = np.concatenate([np.arange(e, b, -1) - 1 for b, e in zip(indptr[:-1], indptr[1:])])
    twice = (np.repeat(0.5 * data[backwards], 2), np.repeat(indices[backwards], 2), 2 * indptr)
    found = []
    for stiffness, of in [((data, indices, indptr), triangle), (twice, triangle), (k, "both")]:
        structure = brinell.Structure(stiffness, rows, gaps, triangle=of)
        structure.solve(load)
        found.append((structure.displacements(), structure.forces))
    assert all((u == found[-1][0]).all() and (f == found[-1][1]).all() for u, f in found)


@pytest.mark.parametrize("width", [np.int32, np.int64])
def test_sparse_arrays_are_not_converted(width):
    # numpy reports its memory to tracemalloc: a conversion would show there.
    k, rows, gaps, load = obstacle(30)
    arrays = [(m.data, m.indices.astype(width), m.indptr.astype(width)) for m in (k, rows)]
    tracemalloc.start()
    try:
        structure = brinell.Structure(*arrays, gaps)
        structure.solve(load)
        _, peak = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    assert peak < 0.1 * k.data.nbytes, peak


@pytest.mark.skipif(not pathlib.Path("/proc/self/status").exists(), reason="the system does not tell the memory of a process")
@pytest.mark.parametrize("width", ["int32", "int64"])
def test_reading_a_matrix_takes_the_memory_of_its_upper_triangle(width):
    program = f"""
import re, brinell, numpy as np
def memory(key):
    return 1024 * int(re.search(key + r":\\s*(\\d+)", open("/proc/self/status").read()).group(1))
n = 2000
matrix = (np.ones(n * n), np.tile(np.arange(n, dtype="{width}"), n), n * np.arange(n + 1, dtype="{width}"))
row = ([1.0], np.zeros(1, "{width}"), np.array([0, 1], "{width}"))
def read(matrix):
    try:
        # Refused when it is read, before it is factored.
        brinell.Structure(matrix, row, [])
    except brinell.InputError as error:
        assert "1 contact rows have 0 gaps" in str(error), error
# Once before: the code of the library takes memory when it first runs.
read((np.ones(1), np.zeros(1, "{width}"), np.array([0, 1], "{width}")))
open("/proc/self/clear_refs", "w").write("5")
before = memory("VmRSS")
read(matrix)
print((memory("VmHWM") - before) / (16 * n * (n + 1) / 2))
"""
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    # Rows and values of 8 bytes each; a megabyte for the rest.
    assert 0.95 < float(done.stdout) < 1.05, done.stdout
