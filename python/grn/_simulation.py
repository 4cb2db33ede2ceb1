"""Swarms in the simulator, and swarms that drove elsewhere measured with its ruler."""

from __future__ import annotations

import json
from dataclasses import dataclass
from os import PathLike, fspath
from typing import Any, Mapping, Optional, Union, overload

import numpy as np
import numpy.typing as npt

from . import _native
from ._arrays import NOT_THERE, Arrays
from ._laboratory import assignments

BlobLike = Union[_native.Blob, str, "PathLike[str]"]
ScenarioLike = Union[_native.Scenario, str, "PathLike[str]"]
Floats = npt.NDArray[np.float64]


class Simulation:
    """A run: every tick of it, and what it was worth.

    Attributes:
        works: whether it met every bar of `grn simulate`.
        metrics: the measures by name; those that need a formed swarm are None without one.
        verdict: each bar, and whether it was met.
        ring_radius: radius of the model's ring around a lone target in free space, metres.
        radial_error_share: median radial error as a share of it; None if the swarm never formed.
        summary: everything that `grn simulate --json` prints.
        times: of each moment, seconds from the start; every tick, or of a long run every second, fourth, ….
        positions: moments x robots x 2, metres.
        headings: moments x robots, radians, anticlockwise from east.
        wheels: moments x robots x 2 (left, right), the commands that led there, motor steps per second.
        targets: moments x targets x 2, metres; NaN while one is not there.
        contacts: moments x 4: pairs and robots at walls that began to touch, and that touch.
    """

    def __init__(self, run: _native.Run) -> None:
        self._run = run
        self.works: bool = run.works
        self.summary: dict[str, Any] = json.loads(run.metrics_json())
        self.metrics: dict[str, Any] = self.summary["metrics"]
        self.verdict: dict[str, bool] = self.summary["verdict"]
        self.ring_radius: float = self.summary["ring_radius_m"]
        self.radial_error_share: Optional[float] = self.summary["radial_error_share"]
        arrays = Arrays(run.arrays())
        self.times: Floats = arrays.times
        self.positions: Floats = arrays.positions
        self.headings: Floats = arrays.headings
        self.wheels: npt.NDArray[np.int16] = arrays.wheels
        self.targets: Floats = arrays.targets
        self.contacts: npt.NDArray[np.uint32] = arrays.contacts

    def save_trace(self, path: Union[str, PathLike[str]]) -> None:
        """Writes the run to a file that `read_trace` reads."""
        self._run.save_trace(path)

    def __repr__(self) -> str:
        robots, works = self.positions.shape[1], "works" if self.works else "does not work"
        return f"<Simulation of {robots} robots, {self.metrics['duration_s']} s: {works}>"


@dataclass(frozen=True)
class Robustness:
    """What came out in many laboratories around one.

    Attributes:
        realities: for each its number, whether it works, and its measures.
        works: in how many it works.
        interval: the 95 % interval of the share in which it works.
    """

    realities: list[dict[str, Any]]
    works: int
    interval: tuple[float, float]


@dataclass
class _Order:
    """What the compiled part is told; the names are those that it reads."""

    blob: BlobLike
    scenario: ScenarioLike
    robots: Optional[int]
    seed: int
    scale: Optional[float]
    speed: float
    dtype: str
    lab: str
    set: list[str]


@overload
def simulate(
    blob: BlobLike,
    scenario: ScenarioLike,
    *,
    robots: Optional[int] = ...,
    seed: int = ...,
    scale: Optional[float] = ...,
    speed: float = ...,
    dtype: str = ...,
    lab: Union[str, PathLike[str]] = ...,
    set: Mapping[str, object] = ...,
    realities: None = ...,
) -> Simulation: ...
@overload
def simulate(
    blob: BlobLike,
    scenario: ScenarioLike,
    *,
    robots: Optional[int] = ...,
    seed: int = ...,
    scale: Optional[float] = ...,
    speed: float = ...,
    dtype: str = ...,
    lab: Union[str, PathLike[str]] = ...,
    set: Mapping[str, object] = ...,
    realities: int,
) -> Robustness: ...
def simulate(
    blob: BlobLike,
    scenario: ScenarioLike,
    *,
    robots: Optional[int] = None,
    seed: int = 1,
    scale: Optional[float] = None,
    speed: float = 0.03,
    dtype: str = "f32",
    lab: Union[str, PathLike[str]] = "ideal",
    set: Mapping[str, object] = {},
    realities: Optional[int] = None,
) -> Union[Simulation, Robustness]:
    """Runs a blob on every robot of a simulated swarm until all targets have arrived, as `grn simulate` does.

    Args:
        blob: the controller, or the path of its file.
        scenario: the world, or the path of its file.
        robots: how many, two of them, or the only one, mother robots; as in the laboratory if it is not given.
        seed: of everything random; equal seeds give equal runs on every machine.
        scale: world metres per scenario metre; the blob's if it is not given.
        speed: of the target with the longest path, metres per second in the world.
        dtype: what the robots compute in, "f32" or "q8.24".
        lab: the conditions: the name of a laboratory that is shipped, or the path of a file.
        set: values of the laboratory to replace, such as `{"radio.loss": 0.3}`.
        realities: runs in so many laboratories drawn around the given one instead, on all cores; the result is a `Robustness`.
    """
    order = _Order(blob, scenario, robots, seed, scale, speed, dtype, fspath(lab), assignments(set))
    if realities is None:
        return Simulation(_native.simulate(order))
    found = json.loads(_native.realities_json(order, realities))
    low, high = found["interval"]
    return Robustness(found["realities"], found["works"], (low, high))


def measure(
    blob: BlobLike,
    scenario: ScenarioLike,
    positions: npt.ArrayLike,
    targets: npt.ArrayLike,
    *,
    contacts: Optional[npt.ArrayLike] = None,
    scale: Optional[float] = None,
    ticks_per_second: int = 32,
) -> Simulation:
    """Measures a swarm that drove elsewhere, on another simulator or on a table, as `simulate` measures its own.

    Args:
        blob: the controller that drove, or the path of its file.
        scenario: the world in which it drove, or the path of its file.
        positions: moments x robots x 2, metres in the world.
        targets: moments x targets x 2, metres in the world; NaN while one is not there.
        contacts: moments x 4, as in `Simulation`; none if they are not given.
        scale: world metres per scenario metre; the blob's if it is not given.
        ticks_per_second: moments per second.
    """
    robots = _micrometres("positions", positions)
    absent = np.isnan(np.asarray(targets, dtype=float))
    places = np.where(absent, NOT_THERE, _micrometres("targets", np.where(absent, 0.0, targets))).astype("<i4")
    touched = np.zeros((len(robots), 4)) if contacts is None else np.asarray(contacts)
    if touched.shape != (len(robots), 4) or len(places) != len(robots):
        raise _native.GrnError(
            f"positions {robots.shape}, targets {places.shape}, contacts {touched.shape}: must have equally many moments"
        )
    return Simulation(
        _native.measure(
            blob,
            scenario,
            scale=scale,
            positions_um=robots.tobytes(),
            targets_um=places.tobytes(),
            contacts=touched.astype("<u4").tobytes(),
            robots=robots.shape[1],
            targets=places.shape[1],
            ticks_per_second=ticks_per_second,
        )
    )


def _micrometres(name: str, metres: npt.ArrayLike) -> npt.NDArray[np.int32]:
    given = np.asarray(metres, dtype=float)
    if given.ndim != 3 or given.shape[2] != 2:
        raise _native.GrnError(f"{name} has the shape {given.shape}: moments x how many x 2 is needed")
    if not np.all(np.abs(given) <= 1000.0):
        raise _native.GrnError(f"{name} holds numbers that are no metres within 1000 of the origin")
    return np.round(given * 1e6).astype("<i4")
