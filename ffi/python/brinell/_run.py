"""Scenes."""

import os

from . import _brinell


def run(scene, overrides=None, *, solver=None, callback=None, estimate=False, **more):
    """Runs a scene and returns its `Result`.

    scene: path of a scene file (a str without line breaks, or a path object), or the text of a scene (TOML).
    overrides: values put over the scene, {"mesh.cylinder_on_half_plane.resolution": 8}; as keywords with two underscores for a dot:
        mesh__cylinder_on_half_plane__resolution=8.
    solver: "cholmod" or "dense".
    callback: called with a dictionary after each accepted increment; something true stops the run, and what was computed is returned
        with `incomplete` set. What it raises (Ctrl-C too) is raised here.
    estimate: estimate the errors of all figures too (summary["accuracy"]); this runs the scene on coarser meshes.

    Raises `Error` (`InputError`, `UnheldError`, `CollapseError`, ...) with `kind`, `status` and, where the run failed on its way,
    `result`. A state whose quality misses its tolerance, or an accuracy that the scene demands (accuracy="1 %") and that was not
    reached, is told by an `InaccurateWarning`; a scene with `accuracy` is run on finer and finer meshes; the result is that of the last, with
    loads, pressures and displacements of the states that the meshes lead to together where these are better known (`accuracy.quantities[].of_mesh`).
    """
    is_path = not isinstance(scene, str) or "\n" not in scene
    values = dict(overrides or {})
    values.update((key.replace("__", "."), value) for key, value in more.items())
    pairs = [f"{key}={_toml(value)}" for key, value in values.items()]
    text = os.fspath(scene) if is_path else scene
    return _brinell.run(text, is_path, pairs, solver, callback, estimate)


def _toml(value, inside=False):
    """A value as TOML; a text that is a value of its own goes as it is."""
    if hasattr(value, "tolist"):
        value = value.tolist()
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, (int, float)):
        return repr(value)
    if isinstance(value, dict):
        return "{" + ", ".join(f"{_key(k)} = {_toml(v, True)}" for k, v in value.items()) + "}"
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(_toml(v, True) for v in value) + "]"
    return _quoted(str(value)) if inside else str(value)


def _key(name):
    return name if name.replace("_", "").replace("-", "").isalnum() else _quoted(name)


def _quoted(text):
    escaped = text.replace("\\", "\\\\").replace('"', '\\"').replace("\n", "\\n")
    return f'"{escaped}"'
