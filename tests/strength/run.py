#!/usr/bin/env python3
"""How many of the faults in faults.py the tests notice: make strength [FAULTS='3 17']

All faults are compiled into one build of a copy of the last commit; BRINELL_MUTANT=n switches number n
on. Unit tests run first, then the program of all integration tests, until a test fails that passes
without faults. Prints a line for each fault and the count.
"""
import json
import os
import shutil
import subprocess
import sys
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


def failures(program, fault, known, first_only):
    """Names of the tests that fail and are not known to; the first one alone, if that is enough."""
    environment = {**os.environ, "BRINELL_MUTANT": str(fault)} if fault else dict(os.environ)
    skip = [word for name in SKIPPED for word in ("--skip", name)]
    run = subprocess.Popen([program, *skip], cwd=COPY, env=environment, text=True,
                           stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)
    found = []
    for line in run.stdout:
        words = line.split()
        if line.startswith("test ") and words[-1] == "FAILED" and words[1] not in known:
            found.append(words[1])
            if first_only:
                run.kill()
                break
    # A program that a fault ends altogether has noticed it, too.
    ended = run.wait()
    if not found and ended not in (0, 101):
        found.append(f"the program ended with {ended}")
    return found


def main():
    shutil.rmtree(COPY, ignore_errors=True)
    subprocess.run(["git", "clone", "--quiet", str(ROOT), str(COPY)], check=True)
    table = COPY / "faults.tsv"
    subprocess.run([sys.executable, str(HERE / "faults.py"), str(COPY), "--tsv", str(table)],
                   check=True)
    programs = [built(*UNOPTIMISED, "--lib"), built("--test", "all")]
    known = {name for program in programs for name in failures(program, 0, set(), False)}
    rows = [line.split("\t") for line in table.read_text().splitlines()[1:]]
    wanted = set(sys.argv[1:])
    rows = [row for row in rows if not wanted or row[0] in wanted]
    missed = 0
    for number, place, _, what, *_ in rows:
        caught = []
        for program in programs:
            caught = caught or failures(program, int(number), known, True)
        missed += not caught
        print(f"{number:>3} {place}: {what}: {caught[0] if caught else 'MISSED'}", flush=True)
    print(f"{len(rows) - missed} of {len(rows)} faults noticed")


main()
