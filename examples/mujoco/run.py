"""Drives e-puck2 bodies in MuJoCo with a controller of grn, beside grn's own simulator.

    python examples/mujoco/run.py BLOB SCENARIO --lab NAME --seed N
"""

from __future__ import annotations

import argparse
import json
import sys
import time
from pathlib import Path
from typing import Any, Callable, Mapping, Optional

import grn

sys.path.insert(0, str(Path(__file__).parent))
from loop import Swarm  # noqa: E402

SPEED = 0.03


def compare(
    blob: grn.Blob,
    scenario: grn.Scenario,
    lab: str,
    changes: Mapping[str, object],
    seed: int,
    watch: Optional[Callable[[float], None]] = None,
) -> dict[str, Any]:
    """The same experiment in both simulators: the measures of each, by the same ruler, and how long each took."""
    begin = time.perf_counter()
    ours = grn.simulate(blob, scenario, seed=seed, speed=SPEED, lab=lab, set=changes)
    middle = time.perf_counter()
    swarm = Swarm(blob, scenario, grn.laboratory(lab, set=changes), ours, seed, SPEED)
    positions, targets, contacts = swarm.run(watch)
    theirs = grn.measure(blob, scenario, positions, targets, contacts=contacts)
    end = time.perf_counter()
    return {
        "seed": seed,
        "mujoco": summary(theirs) | {"seconds": end - middle},
        "grn": summary(ours) | {"seconds": middle - begin},
    }


def summary(run: grn.Simulation) -> dict[str, Any]:
    """What is compared."""
    return {
        "works": run.works,
        "encircled_share": run.metrics["encircled_share"] or 0.0,
        "radial_error_share": run.radial_error_share,
        "formed_at_s": run.metrics["formed_at_s"],
        "peer_contacts": run.metrics["peer_contacts"],
        "wall_contacts": run.metrics["wall_contacts"],
        "verdict": run.verdict,
    }


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("blob", type=Path)
    parser.add_argument("scenario", type=Path)
    parser.add_argument("--lab", default="ideal", help="name or file of a laboratory")
    parser.add_argument("--set", action="append", default=[], metavar="KEY=VALUE", help="replaces one of its values")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--json", action="store_true", help="print JSON instead of a table")
    arguments = parser.parse_args()
    changes = dict(assignment.split("=", 1) for assignment in arguments.set)
    try:
        blob, scenario = grn.Blob.load(arguments.blob), grn.Scenario.load(arguments.scenario)
        result = compare(blob, scenario, arguments.lab, changes, arguments.seed, None if arguments.json else progress)
    except grn.GrnError as error:
        raise SystemExit(f"run.py: {error}") from error
    if arguments.json:
        print(json.dumps(result))
        return
    print(f"\r{'':<28}{'MuJoCo':>12}{'grn':>12}")
    for name, key in (("encircled after forming", "encircled_share"), ("median radial error / ring", "radial_error_share")):
        cells = [result[engine][key] for engine in ("mujoco", "grn")]
        print(f"{name:<28}" + "".join("     unknown" if cell is None else f"{cell:>12.2%}" for cell in cells))
    for name, key in (("formed after, s", "formed_at_s"), ("peer contacts", "peer_contacts"), ("wall contacts", "wall_contacts"), ("works", "works"), ("computed in, s", "seconds")):
        cells = [result[engine][key] for engine in ("mujoco", "grn")]
        print(f"{name:<28}" + "".join(f"{cell:>12.2f}" if isinstance(cell, float) else f"{cell!s:>12}" for cell in cells))


def progress(share: float) -> None:
    print(f"\rMuJoCo {share:4.0%}", end="", file=sys.stderr, flush=True)


if __name__ == "__main__":
    main()
