import os
import signal
import subprocess
import sys
import textwrap
from pathlib import Path

import grn
import pytest

BUDGET = 1600


def files_of(folder: Path) -> dict[str, bytes]:
    return {str(path.relative_to(folder)): path.read_bytes() for path in sorted(folder.rglob("*")) if path.is_file()}


@pytest.fixture(scope="module")
def evolved(tmp_path_factory):
    """A run of the command's and the same of the package's."""
    from conftest import ROOT

    folder = tmp_path_factory.mktemp("evolved")
    heard = []
    found = grn.evolve(
        ROOT / "scenarios" / "channel.toml", out=folder / "ours", evaluations=BUDGET, seed=5, realities=2, progress=heard.append
    )
    return folder, found, heard


def test_an_evolution_leaves_the_files_of_the_command_line(evolved, grn_command, channel):
    folder, found, _ = evolved
    command = [grn_command, "evolve", str(channel), "--seed", "5", "--realities", "2", "--evaluations", str(BUDGET), "--out", str(folder / "theirs")]
    code = subprocess.run(command, capture_output=True).returncode
    assert code == (0 if found.works else 1)
    ours, theirs = files_of(folder / "ours"), files_of(folder / "theirs")
    assert sorted(ours) == sorted(theirs)
    assert [name for name in ours if ours[name] != theirs[name]] == []
    assert ours["knee.grn"] == found.knee.to_bytes()


def test_progress_is_told_after_every_generation(evolved):
    _, found, heard = evolved
    assert [one.evaluations for one in heard] == [800, 1280]
    assert all(one.budget == BUDGET and one.front >= 0 for one in heard)
    assert not found.notices


def test_a_front_opens_in_pandas(evolved):
    folder, found, _ = evolved
    front = grn.read_front(folder / "ours")
    assert {"nodes", "f2", "violation", "knee", "expression", "blob"} <= set(front.columns)
    assert front["nodes"].is_monotonic_increasing and front["closed-loop"].is_monotonic_decreasing
    assert found.knee in [grn.Blob.load(path) for path in front["blob"]]
    assert grn.Blob.load(front["blob"][0]).evaluate(folder / "ours" / "scenario.toml").f2 == front["f2"][0]
    with pytest.raises(grn.GrnError, match="is not there"):
        grn.read_front(folder)


def test_a_trace_opens_in_pandas(evolved):
    folder, _, _ = evolved
    trace = grn.read_trace(folder / "ours")
    robots = trace[trace["kind"] == "robot"]
    assert trace.attrs["scenario"] == "channel" and robots["index"].nunique() == 12
    assert len(trace) == 13 * (trace["tick"].max() + 1)
    assert robots[["x", "y", "heading", "left", "right"]].notna().all().all()
    target = trace[trace["kind"] == "target"]
    assert (target["y"] == 2.5).all() and target["x"].iloc[-1] == pytest.approx(4.25)
    with pytest.raises(grn.GrnError, match="not a trace"):
        grn.read_trace(folder / "ours" / "knee.grn")


def test_a_run_is_resumed_to_the_same_files(evolved, channel):
    folder, _, _ = evolved
    grn.evolve(channel, out=folder / "shorter", evaluations=800, seed=5, realities=2)
    with pytest.raises(grn.GrnError, match="a run is here already"):
        grn.evolve(channel, out=folder / "shorter", evaluations=BUDGET, seed=5, realities=2)
    grn.evolve(channel, out=folder / "shorter", evaluations=BUDGET, seed=5, realities=2, resume=True, threads=1)
    assert files_of(folder / "shorter") == files_of(folder / "ours")


def test_an_exception_of_the_callback_stops_the_search(channel, tmp_path):
    def fail(_):
        raise RuntimeError("enough")

    with pytest.raises(RuntimeError, match="enough"):
        grn.evolve(channel, out=tmp_path / "run", evaluations=100_000, progress=fail)
    assert (tmp_path / "run" / "checkpoint.json").exists()


@pytest.mark.skipif(os.name != "posix", reason="signals of Unix")
def test_ctrl_c_interrupts_and_keeps_what_was_done(channel, tmp_path):
    program = textwrap.dedent(
        f"""
        import signal

        import grn

        # A shell's background jobs, and so whatever tests run in them, ignore Ctrl-C.
        signal.signal(signal.SIGINT, signal.default_int_handler)
        try:
            grn.evolve({str(channel)!r}, out={str(tmp_path / "run")!r}, evaluations=1_000_000, realities=1, progress=lambda p: print(p, flush=True))
        except KeyboardInterrupt:
            print("interrupted", flush=True)
        """
    )
    child = subprocess.Popen([sys.executable, "-c", program], stdout=subprocess.PIPE, text=True)
    assert "evaluations" in child.stdout.readline()
    child.send_signal(signal.SIGINT)
    told, _ = child.communicate(timeout=60)
    assert told.endswith("interrupted\n") and child.returncode == 0
    assert (tmp_path / "run" / "checkpoint.json").exists() and not (tmp_path / "run" / "knee.grn").exists()


@pytest.mark.parametrize(
    ("wrong", "text"),
    [
        ({"objectives": ["nodes"]}, "two or three"),
        ({"objectives": ["nodes", "speed"]}, "speed"),
        ({"motifs": "some"}, "all or binary"),
        ({"constraints": ["islands"]}, "islands"),
        ({"realities": 0}, "realities = 0"),
        ({"paper": True, "realities": 3}, "paper"),
        ({"evaluations": 10}, "the first generation alone takes 800"),
        ({"scale": 1000.0}, "scale"),
        ({"threads": 0}, "threads = 0"),
    ],
)
def test_impossible_settings_are_refused_before_anything_is_written(channel, tmp_path, wrong, text):
    with pytest.raises(grn.GrnError, match=text):
        grn.evolve(channel, out=tmp_path / "run", **{"evaluations": 800, **wrong})
    assert not (tmp_path / "run").exists()
