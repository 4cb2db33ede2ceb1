"""The short form of `cargo xtask crosscheck`: one model, ideal conditions, a fast target."""

import json
import subprocess
import sys
from pathlib import Path

import grn
import pytest

EXAMPLE = Path(__file__).resolve().parents[2] / "examples" / "mujoco"
sys.path.insert(0, str(EXAMPLE))
np = pytest.importorskip("numpy")
pytest.importorskip("mujoco")

import conditions  # noqa: E402
import run  # noqa: E402
import world  # noqa: E402


@pytest.mark.parametrize("seed", [1, 2])
def test_both_simulators_agree_in_ideal_conditions(model, channel, seed, monkeypatch):
    monkeypatch.setattr(run, "SPEED", 0.1)
    found = run.compare(grn.Blob.load(model), grn.Scenario.load(channel), "ideal", {}, seed)
    ours, theirs = found["grn"], found["mujoco"]
    assert ours["works"] and theirs["works"], found
    assert abs(ours["encircled_share"] - theirs["encircled_share"]) <= 0.03
    assert abs(ours["radial_error_share"] - theirs["radial_error_share"]) <= 0.01
    assert abs(ours["formed_at_s"] - theirs["formed_at_s"]) <= 1.0


def test_the_example_runs_as_written(root, desk):
    line = next(line for line in (EXAMPLE / "README.md").read_text().splitlines() if line.startswith("python "))
    arguments = [sys.executable, *line.split()[1:], "--json"]
    # The shipped scenario takes two minutes of simulated time; a shorter path takes a quarter of that.
    short = desk / "scenarios" / "channel.toml"
    short.write_text(short.read_text().replace("[17.0000, 10.0000]", "[6.0000, 10.0000]"))
    done = subprocess.run(arguments, cwd=desk, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert json.loads(done.stdout)["mujoco"]["works"]


def test_a_body_goes_where_its_wheels_take_it(channel):
    scene = grn.Scenario.load(channel).scaled(0.25)
    robot = world.build(scene, np.array([[0.75, 2.5]]), np.array([0.5]), [1.0])
    x, y, heading, farthest = 0.75, 2.5, 0.5, 0.0
    for tick in range(160):
        forwards, aside = 0.1 * np.sin(tick / 40), 0.02 * np.sin(tick / 13)
        robot.drive(0, (forwards - aside) / 0.0205, (forwards + aside) / 0.0205)
        for _ in range(world.STEPS_PER_SECOND // 32):
            world.mujoco.mj_step(robot.model, robot.data)
        turn = 2 * aside / 0.053 / 32
        x += forwards / 32 * np.cos(heading + turn / 2)
        y += forwards / 32 * np.sin(heading + turn / 2)
        heading += turn
        world.mujoco.mj_kinematics(robot.model, robot.data)
        farthest = max(farthest, float(np.hypot(*(robot.positions()[0] - (x, y)))))
    assert 0.0 < farthest < 0.001


def test_a_ray_meets_walls_and_robots(channel):
    scene = grn.Scenario.load(channel).scaled(0.25)
    places = np.array([[2.5, 3.42], [2.4, 3.42]])
    bodies = world.build(scene, places, np.zeros(2), [1.0, 1.0])
    assert bodies.ray((2.5, 3.42), (0.0, 1.0), 0) == pytest.approx(0.08, abs=1e-4)
    assert bodies.ray((2.5, 3.42), (-1.0, 0.0), 0) == pytest.approx(0.065, abs=1e-4)
    assert bodies.ray((2.5, 3.42), (1.0, 0.0), 0) == float("inf")


def test_disturbances_have_their_sizes():
    lab = grn.laboratory(
        "ideal",
        set={
            "localisation.noise_m": 0.01,
            "localisation.noise_deg": 2.0,
            "localisation.drift_m": 0.02,
            "localisation.drift_s": 2.0,
            "localisation.latency_s": 0.1,
            "localisation.dropout": 0.3,
            "localisation.dropout_s": 0.5,
        },
    )
    errors, ages, missing = [], [], 0
    sense = conditions.Localisation(lab, seed=1, robot=0)
    for tick in range(20_000):
        sense.measure(tick / 32, (1.0, 2.0), 0.3)
        fix = sense.newest(tick / 32)
        if fix is None:
            missing += 1
            continue
        errors.append([fix.position[0] - 1.0, fix.position[1] - 2.0, np.degrees(fix.heading - 0.3)])
        ages.append(fix.age)
    deviation = np.std(errors, axis=0)
    assert deviation[:2] == pytest.approx(np.hypot(0.01, 0.02), rel=0.15)
    assert deviation[2] == pytest.approx(2.0, rel=0.05)
    assert missing / 20_000 == pytest.approx(0.3, abs=0.05)
    assert np.mean(ages) == pytest.approx(0.125, abs=1e-6)
