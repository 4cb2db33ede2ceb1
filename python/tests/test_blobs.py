import subprocess

import grn
import pytest


def test_a_blob_is_what_its_file_says(model, tmp_path):
    blob = grn.Blob.load(model)
    assert blob.to_bytes() == model.read_bytes()
    assert blob == grn.Blob.from_bytes(model.read_bytes())
    assert blob.nodes == 5 and "XNOR" in blob.expression.upper()
    assert 0.2 < blob.ring_radius < 0.6
    larger = blob.with_scale(1.0)
    assert larger.scale == 1.0 and larger.ring_radius == pytest.approx(4 * blob.ring_radius)
    larger.save(tmp_path / "larger.grn")
    assert grn.Blob.load(tmp_path / "larger.grn") == larger != blob


def test_steady_states_are_those_of_the_command_line(model, grn_command):
    blob = grn.Blob.load(model)
    inputs = [(0.0, 0.0), (0.5, 0.25), (1.0, 0.0), (2.0, 1.0), (-1.0, 100.0)]
    lines = "".join(f"{x1},{x2}\n" for x1, x2 in inputs)
    for dtype in ("f64", "f32", "q8.24"):
        command = [grn_command, "eval", str(model), "--number", dtype]
        told = subprocess.run(command, input=lines, capture_output=True, text=True, check=True).stdout.split()
        ours = [blob.steady_state(x1, x2, dtype) for x1, x2 in inputs]
        assert ours == pytest.approx([float(line) for line in told], rel=1e-7)


def test_evaluation_is_that_of_evolution(model, channel):
    found = grn.Blob.load(model).evaluate(channel)
    assert found.feasible and found.violation == 0.0 and 0.0 < found.f2 < 0.2
    assert grn.Blob.load(model).evaluate(grn.Scenario.load(channel)).f2 == found.f2


def test_what_is_refused_says_what_and_where(model, channel, tmp_path):
    cut = tmp_path / "cut.grn"
    cut.write_bytes(model.read_bytes()[:20])
    with pytest.raises(grn.GrnError, match="cut.grn: 20 bytes"):
        grn.Blob.load(cut)
    with pytest.raises(grn.GrnError, match="missing.grn: cannot be read"):
        grn.simulate(tmp_path / "missing.grn", channel)
    with pytest.raises(grn.GrnError, match="scenario"):
        grn.Blob.load(channel)
    with pytest.raises(grn.GrnError, match="dtype = \"f16\""):
        grn.Blob.load(model).steady_state(0.0, 0.0, "f16")
    with pytest.raises(grn.GrnError, match="scale"):
        grn.Blob.load(model).with_scale(1e9)
    wrong = tmp_path / "wrong.toml"
    wrong.write_text(channel.read_text().replace("snapshots = 15", "snapshots = 0"))
    with pytest.raises(grn.GrnError, match=r"wrong.toml:4:\d+: snapshots = 0"):
        grn.Scenario.load(wrong)


def test_scenarios_tell_the_world(channel):
    world = grn.Scenario.load(channel)
    assert world.name == "channel" and world.region == (20.0, 20.0)
    assert world.targets_at(0.5) == [(10.0, 10.0)] and world.longest_path == 14.0
    assert len(world.walls) == 2 and world.walls[0][0] == (6.0, 14.0)
    assert world.clearance((10.0, 13.0)) == pytest.approx(1.0)
    quarter = world.scaled(0.25)
    assert quarter.region == (5.0, 5.0) and quarter.paths == [[(0.75, 2.5), (4.25, 2.5)]]
    assert grn.Scenario.from_toml(world.to_toml()) == world
