"""Models x laboratories x seeds in MuJoCo and in grn's own simulator, side by side: writes docs/crosscheck.md.

`cargo xtask crosscheck` runs it. Every run is kept in a file of its own, so that it goes on where it was stopped; a changed
program or example begins anew.
"""

from __future__ import annotations

import argparse
import hashlib
import json
import statistics
import sys
import time
from concurrent.futures import ProcessPoolExecutor, as_completed
from pathlib import Path
from typing import Any, Sequence

import grn

sys.path.insert(0, str(Path(__file__).parent))
from run import SPEED, compare  # noqa: E402

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent.parent
SCENARIO = ROOT / "scenarios" / "channel.toml"
MODELS = ["nand-xnor", "andn-xnor", "andn-nand-xnor", "eh-grn-1", "eh-grn-2"]
LABS = {"ideal": "ideal", "MOD": str(HERE / "labs" / "mod.toml"), "HARD": str(HERE / "labs" / "hard.toml")}
# What agreement means.
ENCIRCLED_POINTS = 0.03
ERROR_SHARE = 0.15
ERROR_OF_RING = 0.01
SAME_VERDICT = 0.95


def program() -> str:
    """A digest of everything that decides a run."""
    files = [*Path(grn.__file__).parent.glob("_native*"), *HERE.glob("*.py"), *HERE.glob("labs/*.toml"), SCENARIO]
    digest = hashlib.sha256()
    for file in sorted(files):
        digest.update(file.read_bytes())
    return digest.hexdigest()[:16]


def one(model: Path, lab: str, seed: int, kept: Path) -> dict[str, Any]:
    """One experiment, or what is kept of it."""
    if kept.exists():
        return json.loads(kept.read_text())
    result = compare(grn.Blob.load(model), grn.Scenario.load(SCENARIO), LABS[lab], {}, seed)
    kept.parent.mkdir(parents=True, exist_ok=True)
    unfinished = kept.with_suffix(".unfinished")
    unfinished.write_text(json.dumps(result))
    unfinished.rename(kept)
    return result


def evolved(folder: Path) -> Path:
    """A knee of the paper's algorithm, evolved anew if need be."""
    if not (folder / "knee.grn").exists():
        print("evolving a knee for scenarios/channel.toml, seed 1", flush=True)
        grn.evolve(SCENARIO, out=folder, seed=1, paper=True, resume=(folder / "manifest.json").exists())
    return folder / "knee.grn"


def mean(values: Sequence[float]) -> float:
    return statistics.fmean(values)


def row(model: str, lab: str, runs: list[dict[str, Any]]) -> dict[str, Any]:
    """What came out of one model in one laboratory. An unknown radial error counts as one ring."""
    engines = {}
    for engine in ("mujoco", "grn"):
        found = [run[engine] for run in runs]
        errors = [1.0 if one["radial_error_share"] is None else one["radial_error_share"] for one in found]
        engines[engine] = {
            "encircled": mean([one["encircled_share"] for one in found]),
            "error": statistics.median(errors),
            "works": sum(one["works"] for one in found),
            "seconds": mean([one["seconds"] for one in found]),
        }
    ours, theirs = engines["grn"], engines["mujoco"]
    same = sum(run["mujoco"]["works"] == run["grn"]["works"] for run in runs)
    difference = abs(ours["error"] - theirs["error"])
    return {
        "model": model,
        "lab": lab,
        "runs": len(runs),
        "same": same,
        **engines,
        "encircled agrees": abs(ours["encircled"] - theirs["encircled"]) <= ENCIRCLED_POINTS,
        "error agrees": difference <= max(ERROR_OF_RING, ERROR_SHARE * max(ours["error"], theirs["error"])),
        "verdict agrees": same >= SAME_VERDICT * len(runs),
    }


def document(rows: list[dict[str, Any]], seeds: int, time_taken: dict[str, float]) -> str:
    """docs/crosscheck.md."""
    labs = [lab for lab in LABS if any(row["lab"] == lab for row in rows)]
    table = [
        "| model | laboratory | encircled, MuJoCo | grn | error / ring, MuJoCo | grn | works, MuJoCo | grn | same verdict | agrees |",
        "|---|---|---|---|---|---|---|---|---|---|",
    ]
    for row in rows:
        ours, theirs = row["grn"], row["mujoco"]
        failing = [what for what in ("encircled", "error", "verdict") if not row[f"{what} agrees"]]
        table.append(
            f"| {row['model']} | {row['lab']} | {theirs['encircled']:.1%} | {ours['encircled']:.1%} | {theirs['error']:.1%} "
            f"| {ours['error']:.1%} | {theirs['works']}/{row['runs']} | {ours['works']}/{row['runs']} "
            f"| {row['same']}/{row['runs']} | {'yes' if not failing else 'not in ' + ', '.join(failing)} |"
        )
    same, runs = sum(row["same"] for row in rows), sum(row["runs"] for row in rows)
    agreeing = sum(all(row[f"{what} agrees"] for what in ("encircled", "error", "verdict")) for row in rows)
    by_lab = [
        f"{lab} {sum(row['same'] for row in rows if row['lab'] == lab)} of {sum(row['runs'] for row in rows if row['lab'] == lab)}"
        for lab in labs
    ]
    lines = [
        "# Two simulators side by side",
        "",
        "`cargo xtask crosscheck` wrote this page. Twelve e-puck2 robots, two of them mothers, accompany the target of",
        f"`scenarios/channel.toml` at scale 0.25 and {SPEED} m/s: in MuJoCo, as rigid bodies on wheels with friction and contacts",
        "([examples/mujoco](../examples/mujoco)), and in `grn simulate`. Both start from the same poses and take their",
        "disturbances from the same laboratory's numbers, each with code and random numbers of its own, and both are measured with",
        f"the same ruler. {'Seed 1' if seeds == 1 else f'Seeds 1 to {seeds}'} each; `encircled` is the mean over seeds, `error` the median over seeds of the median radial error",
        "as a share of the ring's radius.",
        "",
        f"They agree where `encircled` is within {ENCIRCLED_POINTS * 100:.0f} points, `error` within {ERROR_SHARE:.0%} or {ERROR_OF_RING:.0%} of the ring, and the",
        f"verdict (works or not, as `grn simulate` tells) is the same in at least {SAME_VERDICT:.0%} of the runs.",
        "",
        f"**Agreement in {agreeing} of {len(rows)} rows; the same verdict in {same} of {runs} runs ({', '.join(by_lab)}).** A run takes",
        f"{time_taken['mujoco']:.1f} s in MuJoCo and {time_taken['grn']:.2f} s in `grn`, on one core each of a machine that did other things, too.",
        "",
        *table,
        "",
        "The laboratories are `grn lab ideal`, [MOD](../examples/mujoco/labs/mod.toml) and [HARD](../examples/mujoco/labs/hard.toml);",
        "`evolved knee` is that of `grn evolve scenarios/channel.toml`.",
        "",
    ]
    return "\n".join(lines)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--out", type=Path, default=ROOT / "docs" / "crosscheck.md")
    parser.add_argument("--kept", type=Path, default=ROOT / "target" / "crosscheck", help="folder of finished runs")
    parser.add_argument("--seeds", type=int, default=10)
    parser.add_argument("--labs", nargs="+", default=list(LABS), choices=list(LABS))
    parser.add_argument("--models", nargs="+", default=[*MODELS, "evolved knee"], choices=[*MODELS, "evolved knee"])
    parser.add_argument("--processes", type=int, default=2)
    arguments = parser.parse_args()
    kept = arguments.kept / program()
    paths = {name: ROOT / "models" / f"{name}.grn" for name in arguments.models}
    if "evolved knee" in paths:
        paths["evolved knee"] = evolved(kept / "knee")
    jobs = [(model, lab, seed) for lab in arguments.labs for model in paths for seed in range(1, arguments.seeds + 1)]
    found: dict[tuple[str, str, int], dict[str, Any]] = {}
    begin = time.monotonic()
    with ProcessPoolExecutor(arguments.processes) as pool:
        work = {
            pool.submit(one, paths[model], lab, seed, kept / f"{model}-{lab}-{seed}.json"): (model, lab, seed)
            for model, lab, seed in jobs
        }
        for done in as_completed(work):
            found[work[done]] = done.result()
            model, lab, seed = work[done]
            theirs, ours = done.result()["mujoco"]["works"], done.result()["grn"]["works"]
            verdict = f"works: MuJoCo {'yes' if theirs else 'no'}, grn {'yes' if ours else 'no'}"
            print(f"{len(found)}/{len(jobs)} {model}, {lab}, seed {seed}: {verdict}, {time.monotonic() - begin:.0f} s", flush=True)
    rows = [
        row(model, lab, [found[model, lab, seed] for seed in range(1, arguments.seeds + 1)])
        for lab in arguments.labs
        for model in paths
    ]
    taken = {engine: mean([run[engine]["seconds"] for run in found.values()]) for engine in ("mujoco", "grn")}
    arguments.out.write_text(document(rows, arguments.seeds, taken))
    print(f"{arguments.out} written")


if __name__ == "__main__":
    main()
