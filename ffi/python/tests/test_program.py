"""The program within the package."""

import json
import signal
import subprocess
import sys
import time

import brinell

PROGRAM = [sys.executable, "-m", "brinell"]


def test_the_program_makes_and_runs_a_scene(tmp_path):
    made = [*PROGRAM, "new", "ball-on-flat", "--load", "20", "--resolution", "4", "--out", "ball.toml"]
    subprocess.run(made, check=True, cwd=tmp_path, capture_output=True)
    ran = subprocess.run([*PROGRAM, "run", "ball.toml", "-q", "--json"], check=True, cwd=tmp_path, capture_output=True)
    summary = json.loads(ran.stdout)
    result = brinell.run(tmp_path / "ball.toml")
    assert summary["states"][-1]["residual_depth"] == result[-1].residual_depth
    wrong = subprocess.run([*PROGRAM, "run", "bal.toml"], cwd=tmp_path, capture_output=True, text=True)
    assert wrong.returncode != 0 and "bal.toml" in wrong.stderr
    usage = subprocess.run([*PROGRAM, "ruin"], cwd=tmp_path, capture_output=True, text=True)
    assert usage.returncode == 2 and "Usage: brinell" in usage.stderr


def test_a_sweep_runs_itself(tmp_path):
    brinell.new("ball-on-flat", load=20, resolution=4, out=tmp_path / "ball.toml")
    sweep = [*PROGRAM, "sweep", "ball.toml", "--vary", "materials.steel.yield_stress=400,500", "--no-estimate", "--no-report"]
    subprocess.run(sweep, check=True, cwd=tmp_path, capture_output=True)
    assert len((tmp_path / "ball.sweep" / "sweep.csv").read_text().splitlines()) == 3


def test_ctrl_c_ends_it_in_order(tmp_path):
    brinell.new("ball-on-flat", load=60, three_dimensional=True, out=tmp_path / "ball.toml")
    running = subprocess.Popen([*PROGRAM, "run", "ball.toml"], cwd=tmp_path, stderr=subprocess.PIPE, text=True)
    for line in running.stderr:
        if "load program" in line:
            break
    time.sleep(0.1)
    running.send_signal(signal.SIGINT)
    said = running.stderr.read()
    assert running.wait(60) == 130, said
    assert "Ctrl-C" in said
