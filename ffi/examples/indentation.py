"""What indentation.c does, in Python: the same lines.

Run: python indentation.py SCENE, with brinell installed (pip install ./ffi/python)
"""

import sys
from concurrent.futures import ThreadPoolExecutor

import brinell
import numpy as np


def analyse(scene):
    increments = []
    result = brinell.run(scene, callback=increments.append, mesh__cylinder_on_half_plane__resolution=6)
    displacement = 0.0
    for u in result[-1].fields["displacement"].ravel().tolist():
        displacement += u * u
    return (
        f"increments {len(increments)}, states {len(result)}, yield load {result.first_yield['load']:.15e}, "
        f"largest pressure {max(result.history['max_pressure']):.15e}, dent {result[-1].residual_depth:.15e}, "
        f"displacement {displacement:.15e}"
    )


def blocks():
    """Half of two blocks from arrays: pairs with gaps that grow from the middle, pressed together until they flow, and let go."""
    nx, ny = 4, 2
    node = np.arange(2 * (ny + 1) * (nx + 1)).reshape(2, ny + 1, nx + 1)
    x = 0.5 * np.arange(nx + 1)
    model = brinell.Model("plane_strain", symmetry=2)
    for body, name in enumerate(["lower", "upper"]):
        for j in range(ny + 1):
            model.nodes(np.column_stack([x, np.full(nx + 1, body + 0.5 * j)]))
        n = node[body]
        model.elements(name, np.stack([n[:-1, :-1], n[:-1, 1:], n[1:, 1:], n[1:, :-1]], axis=-1).reshape(-1, 4))
        model.body(name, "steel")
    model.surface_of_nodes("floor", node[0, 0])
    model.surface_of_nodes("face", node[0, -1])
    model.surface_of_nodes("opposite", node[1, 0])
    model.surface_of_nodes("top", node[1, -1])
    model.node_set("middle", node[:, :, 0])
    model.material("steel", youngs_modulus=210e3, poissons_ratio=0.3, yield_stress=300, plastic_modulus=2100)
    model.contact("opposite", "face", pairs=np.column_stack([node[1, 0], node[0, -1]]), gap=0.002 * x * x)
    model.support("floor", "y")
    model.support("middle", "x")
    model.load("top", pressure=300)
    model.target(load_factor=1)
    model.target(load_factor=0)
    result = model.run()
    loaded = result[0]
    print(
        f"blocks: contact force {loaded.contact_force:.15e}, largest pressure {loaded.max_pressure:.15e}, "
        f"points that flow {loaded.plastic_points}"
    )
    print("gaps left:", *(f"{gap:.15e}" for gap in result[1].pairs["gap"]))


def springs():
    """Freedoms 0-1-2 in a row, unit springs between them, 0 tied to the ground; a wall at distance 1 before freedom 2."""
    upper = ([2.0, -1.0, 2.0, -1.0, 1.0], [0, 0, 1, 1, 2], [0, 1, 3, 5])
    structure = brinell.Structure(upper, [[0, 0, 1]], [1.0], triangle="upper")
    condensed = structure.condensed_stiffness
    print(f"condensed stiffness {condensed.shape[0]} x {condensed.shape[1]}: {condensed[0, 0]:.15e}")
    structure.start([0, 0, 1])
    t, changes = structure.step(2.0)
    for row, closes in changes:
        print(f"row {row} {'closes' if closes else 'opens'} at t = {t:.15e}")
    t, changes = structure.step(2.0)
    print(f"force at t = {t:.15e}: {structure.forces[0]:.15e}")
    u = structure.displacements()
    print(f"displacements {u[0]:.15e} {u[1]:.15e} {u[2]:.15e}, closed {int(structure.closed[0])}")


def main(scene):
    # Two analyses in two threads at once.
    with ThreadPoolExecutor(2) as pool:
        for line in pool.map(analyse, [scene, scene]):
            print(line)
    # A callback that stops, and an error with its reason.
    result = brinell.run(scene, callback=lambda increment: increment["increment"] >= 3)
    print(f"stopped with status {130 if result.incomplete else 0} after {len(result.history['alpha'])} increments")
    try:
        brinell.run("kind = 3\n")
    except brinell.Error as error:
        print(f"refused with status {error.status}: {error}")
    blocks()
    springs()


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit("usage: indentation.py SCENE")
    main(sys.argv[1])
