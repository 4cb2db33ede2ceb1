import json
import subprocess

import grn
import numpy as np
import pytest


def test_a_simulation_is_that_of_the_command_line(model, channel, grn_command, tmp_path):
    command = [grn_command, "simulate", str(model), str(channel), "--seed", "3", "--json", "--out", str(tmp_path / "run")]
    told = json.loads(subprocess.run(command, capture_output=True, text=True, check=True).stdout)
    run = grn.simulate(model, channel, seed=3)
    assert run.works and run.works == told["works"]
    for key in ("metrics", "verdict", "ring_radius_m", "radial_error_share", "blob", "seed"):
        assert run.summary[key] == told[key], key
    run.save_trace(tmp_path / "trace.bin")
    assert (tmp_path / "trace.bin").read_bytes() == (tmp_path / "run" / "trace.bin").read_bytes()


def test_arrays_have_their_shapes_and_units(model, channel):
    run = grn.simulate(model, channel, robots=5, seed=2, dtype="q8.24", speed=0.1)
    moments = len(run.times)
    assert run.positions.shape == (moments, 5, 2) and run.headings.shape == (moments, 5)
    assert run.targets.shape == (moments, 1, 2) and run.wheels.shape == (moments, 5, 2)
    assert run.contacts.shape == (moments, 4)
    assert run.times[32] == 1.0 and run.times[-1] == run.metrics["duration_s"]
    assert tuple(run.targets[0, 0]) == (0.75, 2.5) and run.targets[-1, 0] == pytest.approx((4.25, 2.5))
    # What the wheels were told is how far robots went.
    way = np.hypot(*np.diff(run.positions, axis=0).transpose(2, 0, 1))
    told = np.abs(run.wheels[1:].mean(axis=2)) * 0.041 * np.pi / 1000 / 32
    assert np.median(np.abs(way - told)) < 1e-4
    assert np.abs(run.wheels).max() <= 1100 and np.abs(run.headings).max() <= np.pi


def test_what_drove_here_measures_the_same_elsewhere(model, channel):
    run = grn.simulate(model, channel, seed=4)
    again = grn.measure(model, channel, run.positions, run.targets, contacts=run.contacts)
    assert again.metrics == run.metrics and again.verdict == run.verdict
    still = grn.measure(model, channel, run.positions[:1].repeat(400, axis=0), run.targets[:1].repeat(400, axis=0))
    assert not still.works and still.metrics["formed_at_s"] is None


def test_a_laboratory_s_numbers_are_those_of_the_command_line(grn_command):
    numbers = grn.laboratory("ideal", set={"radio.loss": 0.25, "timing.in_phase": False})
    assert numbers["radio"]["loss"] == 0.25 and numbers["timing"]["in_phase"] is False
    assert numbers["localisation"]["rate_hz"] == 32.0 and numbers["robots"] == {"count": 12, "mothers": 2}
    with pytest.raises(grn.GrnError, match="did you mean radio.loss"):
        grn.laboratory("ideal", set={"radio.lost": 0.25})
    with pytest.raises(grn.GrnError, match="no laboratory of this name"):
        grn.laboratory("idea")


def test_a_run_in_a_laboratory_is_that_of_the_command_line(model, channel, grn_command):
    command = [grn_command, "simulate", str(model), str(channel), "--lab", "hostile", "--set", "radio.loss=0.4", "--json"]
    told = json.loads(subprocess.run(command, capture_output=True, text=True).stdout)
    run = grn.simulate(model, channel, lab="hostile", set={"radio.loss": 0.4})
    assert run.summary["metrics"] == told["metrics"] and run.summary["laboratory"] == "hostile"
    assert run.metrics != grn.simulate(model, channel).metrics


def test_a_world_s_own_swarm_goes_before_the_laboratory(model, channel, tmp_path):
    world = tmp_path / "world.toml"
    world.write_text(channel.read_text() + "\n[swarm]\nrobots = 14\n")
    run = grn.simulate(model, world, speed=0.1)
    assert run.positions.shape[1] == 14
    with pytest.raises(grn.GrnError, match="set robots.count=9: channel says in .swarm. itself"):
        grn.simulate(model, world, set={"robots.count": 9})


def test_realities_are_those_of_the_command_line(model, channel, grn_command, tmp_path):
    command = [grn_command, "simulate", str(model), str(channel), "--speed", "0.1", "--realities", "5", "--json"]
    told = json.loads(subprocess.run(command, capture_output=True, text=True).stdout)
    found = grn.simulate(model, channel, speed=0.1, realities=5)
    assert [one["number"] for one in found.realities] == [1, 2, 3, 4, 5]
    assert found.works == sum(one["works"] for one in found.realities)
    assert found.interval[0] <= found.works / 5 <= found.interval[1]
    assert found.realities == told["realities"]


def test_impossible_runs_are_refused(model, channel):
    with pytest.raises(grn.GrnError, match="robots"):
        grn.simulate(model, channel, robots=0)
    with pytest.raises(grn.GrnError, match="target_speed_m_per_s"):
        grn.simulate(model, channel, speed=1.0)
    with pytest.raises(grn.GrnError, match="moments"):
        grn.measure(model, channel, np.zeros((3, 2, 2)), np.zeros((4, 1, 2)))
    with pytest.raises(grn.GrnError, match="shape"):
        grn.measure(model, channel, np.zeros((3, 2)), np.zeros((3, 1, 2)))
    with pytest.raises(grn.GrnError, match="no metres"):
        grn.measure(model, channel, np.full((3, 2, 2), np.nan), np.zeros((3, 1, 2)))
