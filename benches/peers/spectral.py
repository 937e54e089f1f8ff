"""The ball of `data/peers/ball_contact.toml` by Tamaas (boundary elements by Fourier transforms).

Two like bodies deform alike: each as a half space under a rigid sphere of twice the radius.
Prints processor seconds and the largest pressure as JSON.
Usage: spectral.py elastic LOAD CELLS | plastic LOAD CELLS LAYERS STEPS
"""

import json
import math
import sys
import time

import numpy as np
import tamaas as tm
from tamaas.nonlinear_solvers import DFSANECXXSolver

YOUNG, POISSON, YIELD, SLOPE, RADIUS = 210e3, 0.3, 500.0, 10.5e3, 20.0
# Contact radius at first yield, 20.35407 N.
AT_YIELD = (3 * 20.35407 * RADIUS * (1 - POISSON**2) / (4 * YOUNG)) ** (1 / 3)


def sphere(cells, size):
    """Heights of the sphere at the cells' middles."""
    x = (np.arange(cells) + 0.5) * size / cells - 0.5 * size
    return -(x[:, None] ** 2 + x[None, :] ** 2) / (2 * RADIUS)


def elastic(load, cells):
    """Largest pressure; the surface ends where the contact does not reach."""
    size = 3 * AT_YIELD
    model = tm.ModelFactory.createModel(tm.model_type.basic_2d, [size] * 2, [cells] * 2)
    model.E, model.nu = YOUNG, POISSON
    tm.ModelFactory.registerNonPeriodic(model, "dcfft")
    solver = tm.PolonskyKeerRey(model, sphere(cells, size), 1e-10)
    solver.setIntegralOperator("dcfft")
    solver.solve(load / size**2)
    return float(np.max(model.traction))


def plastic(load, cells, layers, steps):
    """Largest pressure under `load`, reached in equal steps; the surface is periodic."""
    size, depth = 8 * AT_YIELD, 4 * AT_YIELD
    model = tm.ModelFactory.createModel(
        tm.model_type.volume_2d, [depth, size, size], [layers, cells, cells]
    )
    model.E, model.nu = YOUNG, POISSON
    material = tm.materials.IsotropicHardening(model, YIELD, SLOPE)
    flow = DFSANECXXSolver(tm.Residual(model, material))
    flow.tolerance = 1e-8
    contact = tm.PolonskyKeerRey(model, sphere(cells, size), 1e-10)
    solver = tm.EPICSolver(contact, flow, 1e-6)
    for step in range(1, steps + 1):
        # Which ends with what flowed being kept.
        solver.acceleratedSolve(load / size**2 * step / steps)
    return float(np.max(np.asarray(model.traction)[..., 2]))


def main():
    tm.set_log_level(tm.LogLevel.error)
    tm.initialize(1)
    method = {"elastic": elastic, "plastic": plastic}[sys.argv[1]]
    began = time.process_time()
    pressure = method(float(sys.argv[2]), *map(int, sys.argv[3:]))
    print(json.dumps({"seconds": time.process_time() - began, "pressure": pressure}))


if __name__ == "__main__":
    main()
