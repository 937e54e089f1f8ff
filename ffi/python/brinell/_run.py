"""Scenes."""

import os

from . import _brinell
from ._errors import InputError


def run(scene, overrides=None, *, solver=None, callback=None, estimate=False, threads=None, budget=None, **more):
    """Runs a scene and returns its `Result`.

    scene: path of a scene file (a str without line breaks, or a path object), or the text of a scene (TOML).
    overrides: values put over the scene, {"mesh.cylinder_on_half_plane.resolution": 8}; as keywords with two underscores for a dot:
        mesh__cylinder_on_half_plane__resolution=8. A dictionary is merged with the table in the scene, key by key; None removes a key;
        a list replaces the list, and a key that all entries of the old one have and none of the new is told by a warning.
    solver: "cholmod", "faer" or "dense"; by default the first of them that the package was built with.
    callback: called with a dictionary after each accepted increment; something true stops the run, and what was computed is returned
        with `incomplete` set. What it raises (Ctrl-C too) is raised here.
    threads: how many threads to use, a pool of its own for this run; by default those that all runs share. The callback is then called in one of
        them, not in the calling thread.
    estimate: estimate the errors of all figures too (summary["accuracy"]): True or "quick" takes no more than the run itself, "full" whatever two
        meshes take on which every figure can be read, "none" or False nothing.
    budget: seconds that may be spent on an accuracy that the scene demands: a mesh that would not fit is not begun.

    Raises `Error` (`InputError`, `UnheldError`, `CollapseError`, ...) with `kind`, `status` and, where the run failed on its way,
    `result`. A state whose quality misses its tolerance, or an accuracy that the scene demands (accuracy="1 %") and that was not
    reached, is told by an `InaccurateWarning`; a scene with `accuracy` is run on finer and finer meshes, and the result is that of
    the last.
    """
    effort = {True: "quick", False: "none"}.get(estimate, estimate)
    return _brinell.run(*_scene(scene, overrides, more), solver, callback, effort, threads, budget)


def check(scene, overrides=None, *, solver=None, **more):
    """What a run of the scene would do and cost, without running it: a dictionary with `effects`, `sizes`, `prediction`,
    `available_bytes`, `predicted_seconds`, `predicted_run_seconds`, `notes`. Arguments as of `run`.
    """
    return _brinell.check(*_scene(scene, overrides, more), solver)


def yield_load(scene, overrides=None, *, solver=None, **more):
    """First yield of a scene, a dictionary with `alpha`, `load`, `max_pressure`, `half_width`, `location`, `body`. Elastic, hence
    fast. Arguments as of `run`; raises `AnalysisError` where nothing can yield.
    """
    return _brinell.yield_load(*_scene(scene, overrides, more), solver)


def new(problem, *, out=None, **numbers):
    """A commented scene for a common problem, as `brinell new` makes it: its text, which `run` takes; written to the file `out`
    where that is given and not there yet.
    A mesh that belongs to it ("roller-between-raceways") goes beside that.

    problem: "ball-on-flat", "roller-on-flat", "shaft-in-bore", "punch", "ball-in-groove", "crossed-cylinders",
        "roller-between-raceways", "iso76", "hardness".
    numbers: the options of `brinell new PROBLEM --help` as keywords, with underscores: radius=5, yield_stress=500,
        three_dimensional=True. Units are N, mm and MPa.
    """
    given = [(f"--{key.rstrip('_').replace('_', '-')}", value) for key, value in numbers.items()]
    # Joined, so that a negative number is no option.
    words = [flag if value is True else f"{flag}={value}" for flag, value in given if value is not None and value is not False]
    if out is not None:
        words.append(f"--out={os.fspath(out)}")
    return _brinell.new([problem, *words])


def _scene(scene, overrides, more):
    """The text or path, whether it is a path, and the overrides as `KEY=VALUE`."""
    is_path = not isinstance(scene, str) or "\n" not in scene
    values = dict(overrides or {})
    values.update((key.replace("__", "."), value) for key, value in more.items())
    pairs = [pair for key, value in values.items() for pair in _pairs(key, value)]
    return os.fspath(scene) if is_path else scene, is_path, pairs


def _pairs(key, value):
    """A value as `KEY=VALUE`, and `KEY=` for each key in it that is to be removed."""
    if value is None:
        return [f"{key}="]
    if not isinstance(value, dict):
        return [f"{key}={_toml(value)}"]
    removed = [f"{key}.{_key(k)}" for k, v in value.items() if v is None]
    inner = [pair for k, v in value.items() if isinstance(v, dict) for pair in _pairs(f"{key}.{_key(k)}", v)]
    kept = {k: v for k, v in value.items() if v is not None and not isinstance(v, dict)}
    return [f"{key}={_toml(kept)}"] + inner + [f"{path}=" for path in removed]


def _toml(value, inside=False):
    """A value as TOML; a text that is a value of its own goes as it is."""
    if value is None:
        raise InputError("None removes a key of a table; inside a list there is nothing to remove", "input", 2)
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
    # Nothing at all would remove the key.
    return _quoted(str(value)) if inside or value == "" else str(value)


def _key(name):
    return name if name.replace("_", "").replace("-", "").isalnum() else _quoted(name)


def _quoted(text):
    escaped = text.replace("\\", "\\\\").replace('"', '\\"').replace("\n", "\\n")
    return f'"{escaped}"'
