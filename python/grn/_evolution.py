"""Evolution runs."""

from __future__ import annotations

from dataclasses import dataclass
from os import PathLike, fspath
from pathlib import Path
from typing import Callable, Mapping, Optional, Sequence, Union

from . import _native
from ._laboratory import assignments

_World = Union[_native.Scenario, str, "PathLike[str]"]


@dataclass(frozen=True)
class Evolution:
    """What an evolution left in its folder.

    Attributes:
        out: the folder, which `read_front` opens.
        knee: the controller that is deployed.
        feasible: whether every model of the front is feasible; if not, nothing was simulated.
        works: whether the knee works on the laboratory's simulated robots.
        notices: what the user should hear, such as pictures that could not be drawn.
    """

    out: Path
    knee: _native.Blob
    feasible: bool
    works: bool
    notices: Sequence[str]


def evolve(
    scenario: Union[_World, Sequence[_World]],
    *,
    out: Union[str, PathLike[str]],
    evaluations: int = 4000,
    seed: int = 1,
    paper: bool = False,
    objectives: Optional[Sequence[str]] = None,
    constraints: Optional[Sequence[str]] = None,
    realities: Optional[int] = None,
    motifs: str = "all",
    scale: float = 0.25,
    lab: Union[str, PathLike[str]] = "ideal",
    set: Mapping[str, object] = {},
    threads: Optional[int] = None,
    resume: bool = False,
    progress: Optional[Callable[[_native.Progress], object]] = None,
) -> Evolution:
    """Evolves controllers for a scenario and simulates the knee of the front, as `grn evolve` does and to the same files.

    Ctrl-C, or an exception of `progress`, stops it; the generations that are done are kept, and `resume=True` goes on.

    Args:
        scenario: the world to evolve for, or the path of its file; or several of them: a model is worth the mean of what it is in
            each.
        out: folder of the run, new or empty if it is not to be resumed.
        evaluations: budget, evaluations of f2; larger than before it extends a run that is resumed.
        seed: of everything random; equal seeds give equal files.
        paper: the paper's algorithm to the letter: nodes and f2, enclosed with a clearance of 0.05 m, without trials.
        objectives: what to minimise, two or three of "nodes", "f2", "closed-loop" and "worst"; "nodes" and "closed-loop" if not given.
        constraints: what patterns must keep to, of "enclosed", "clearance" and "no-islands"; all of them if not given.
        realities: trials of each model on the front; 16 if not given.
        motifs: what to build with, "all" or "binary".
        scale: world metres per scenario metre of the blobs.
        lab: the laboratory that models are tried and the knee is simulated in, a name or a file; set replaces some of its values.
        threads: how many; all cores if it is not given. The result does not depend on it.
        resume: continue the run in the folder.
        progress: called after every generation.
    """
    if threads is not None and not 1 <= threads <= 1024:
        raise _native.GrnError(f"threads = {threads}: must be 1 to 1024")
    worlds = [scenario] if isinstance(scenario, (_native.Scenario, str, PathLike)) else list(scenario)
    found = _native.evolve(
        worlds,
        out=out,
        evaluations=evaluations,
        seed=seed,
        paper=paper,
        objectives=None if objectives is None else list(objectives),
        constraints=None if constraints is None else list(constraints),
        realities=realities,
        motifs=motifs,
        scale=scale,
        lab=fspath(lab),
        set=assignments(set),
        threads=threads or 0,
        resume=resume,
        progress=progress,
    )
    return Evolution(Path(out), found.knee, found.feasible, found.works, found.notices)
