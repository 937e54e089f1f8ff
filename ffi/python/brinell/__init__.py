"""Elastoplastic contact without friction on one sparse factorisation.

    import brinell
    result = brinell.run("data/scenes/cylinder_on_half_plane.toml", mesh__cylinder_on_half_plane__resolution=8)
    pandas.DataFrame(result.history)          # a row per increment
    pandas.DataFrame(result[-1].pairs)        # gap, force and pressure along the contact, unloaded

`run` takes a scene, `Model` arrays of nodes and elements, `Structure` a sparse stiffness with contact rows.
"""

from ._brinell import Model, Result, State, Structure, __version__
from ._errors import (
    AnalysisError,
    CollapseError,
    Error,
    InaccurateWarning,
    InputError,
    InternalError,
    IoError,
    MissingError,
    UnheldError,
    UnsupportedError,
)
from ._run import check, new, run, yield_load

__all__ = [
    "AnalysisError",
    "CollapseError",
    "Error",
    "InaccurateWarning",
    "InputError",
    "InternalError",
    "IoError",
    "MissingError",
    "Model",
    "Result",
    "State",
    "Structure",
    "UnheldError",
    "UnsupportedError",
    "__version__",
    "check",
    "new",
    "run",
    "yield_load",
]
