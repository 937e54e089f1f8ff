#!/usr/bin/env python3
"""How many of the faults in faults.py the tests notice: make strength [FAULTS='3 17']

All faults are compiled into one build of a copy of the last commit; BRINELL_MUTANT=n switches number n
on. The suites that a fault is close to run first, then all unit tests and all integration tests, until
a test fails that passes without faults. Prints a line for each fault and the count.
"""
import json
import os
import re
import shutil
import subprocess
import sys
from functools import cache
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent.parent
TARGET = Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target"))
COPY = TARGET / "strength"
FEATURES = ["--features", os.environ.get("TESTED", "capi,faer")]
UNOPTIMISED = [
    "--config", "profile.dev.package.brinell.opt-level=0",
    "--config", "profile.dev.package.brinell.codegen-units=16",
]
# Tests of the tree itself, of which the faults change lines, and of packages.
SKIPPED = ["drift::", "install::", "python::", "header::"]


def built(*arguments):
    """The test program that a build makes."""
    command = ["cargo", "test", "--no-run", "--message-format=json", *FEATURES, *arguments]
    environment = {**os.environ, "CARGO_TARGET_DIR": str(TARGET)}
    output = subprocess.run(command, cwd=COPY, env=environment, stdout=subprocess.PIPE, check=True)
    messages = [json.loads(line) for line in output.stdout.splitlines()]
    programs = [m["executable"] for m in messages if m.get("profile", {}).get("test")]
    return next(program for program in programs if program)


def nearest(suites):
    """Filters of unit and of integration tests: `unit shape; solid (patches, hertz)`."""
    unit, integration = [], []
    for suite, modules in re.findall(r"([\w: ]+?)(?: \(([^)]*)\))?(?:[,;]|$)", suites):
        words = suite.split()
        if words[:1] == ["unit"]:
            unit.append(words[1] + "::")
        elif words:
            inside = modules.split(", ") if modules else [""]
            integration += [f"{words[0]}::{module}" for module in inside]
    return unit, integration


@cache
def passes(program, test):
    """Whether a test passes without faults."""
    command = [program, "--exact", test]
    return subprocess.run(command, cwd=COPY, stdout=subprocess.DEVNULL,
                          stderr=subprocess.DEVNULL).returncode == 0


def noticed(program, fault, filters):
    """The first test of those that pass without faults that fails with this one."""
    environment = {**os.environ, "BRINELL_MUTANT": str(fault)}
    skip = [word for name in SKIPPED for word in ("--skip", name)]
    run = subprocess.Popen([program, *filters, *skip], cwd=COPY, env=environment, text=True,
                           stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)
    for line in run.stdout:
        words = line.split()
        if line.startswith("test ") and words[-1] == "FAILED" and passes(program, words[1]):
            run.kill()
            run.wait()
            return words[1]
    # A program that a fault ends altogether has noticed it, too.
    ended = run.wait()
    return None if ended in (0, 101) else f"the program ended with {ended}"


def main():
    shutil.rmtree(COPY, ignore_errors=True)
    subprocess.run(["git", "clone", "--quiet", str(ROOT), str(COPY)], check=True)
    table = COPY / "faults.tsv"
    subprocess.run([sys.executable, str(HERE / "faults.py"), str(COPY), "--tsv", str(table)],
                   check=True)
    unit, integration = built(*UNOPTIMISED, "--lib"), built("--test", "all")
    rows = [line.split("\t") for line in table.read_text().splitlines()[1:]]
    wanted = set(sys.argv[1:])
    rows = [row for row in rows if not wanted or row[0] in wanted]
    missed = 0
    for number, place, _, what, suites in rows:
        of_unit, of_integration = nearest(suites)
        runs = [(unit, of_unit)] * bool(of_unit) + [(integration, of_integration)] * bool(of_integration)
        runs += [(unit, []), (integration, [])]
        found = (noticed(program, number, filters) for program, filters in runs)
        caught = next((test for test in found if test), None)
        missed += caught is None
        print(f"{number:>3} {place}: {what}: {caught or 'MISSED'}", flush=True)
    print(f"{len(rows) - missed} of {len(rows)} faults noticed")


main()
