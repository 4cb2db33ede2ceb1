"""What runs leave, as pandas tables."""

from __future__ import annotations

from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any, Union

import numpy as np

from . import _native
from ._arrays import Arrays

if TYPE_CHECKING:
    import pandas as pd


def _pandas() -> Any:
    try:
        import pandas
    except ModuleNotFoundError as error:
        raise ModuleNotFoundError("grn.read_front and grn.read_trace need pandas: pip install pandas") from error
    return pandas


def read_front(path: Union[str, PathLike[str]]) -> pd.DataFrame:
    """The front of a run: one line a model, with the columns of its `front.csv`; `blob` is the path of the model's file.

    Args:
        path: the folder of a run, or a `front.csv`.
    """
    table = Path(path)
    if table.is_dir():
        table /= "front.csv"
    if not table.is_file():
        raise _native.GrnError(f"{table}: is not there: give the folder of a finished run")
    front: pd.DataFrame = _pandas().read_csv(table, keep_default_na=False)
    if not {"nodes", "f2", "violation", "knee", "expression", "blob"} <= set(front.columns):
        raise _native.GrnError(f"{table}: is no front: it has the columns {', '.join(front.columns)}")
    front["blob"] = [str(table.parent / blob) for blob in front["blob"]]
    return front


def read_trace(path: Union[str, PathLike[str]]) -> pd.DataFrame:
    """A recorded run: one line for each robot and target at each moment, in SI units.

    The columns are `tick`, `time` (s), `kind` ("robot" or "target"), `index`, `x`, `y` (m), and of robots only `heading`
    (rad), `left`, `right` (the commands that led there, motor steps per second). `attrs` tells what the trace is of.

    Args:
        path: a `trace.bin`, or a folder that holds one, of a simulation or of an evolution.
    """
    pandas = _pandas()
    place = Path(path)
    if place.is_dir():
        here = place / "trace.bin"
        place = here if here.is_file() else place / "simulation" / "trace.bin"
    arrays = Arrays(_native.trace_arrays(place))
    header = arrays.header

    def lines(kind: str, places: Any, **columns: Any) -> Any:
        moments, count, _ = places.shape
        ticks = np.repeat(np.arange(moments) * header["ticks_per_frame"], count)
        flat = {name: values.reshape(-1) for name, values in columns.items()}
        head = {"tick": ticks, "time": ticks / header["ticks_per_second"], "kind": kind}
        at = {"index": np.tile(np.arange(count), moments), "x": places[..., 0].reshape(-1), "y": places[..., 1].reshape(-1)}
        return pandas.DataFrame({**head, **at, **flat})

    wheels = arrays.wheels.astype(float)
    robots = lines("robot", arrays.positions, heading=arrays.headings, left=wheels[..., 0], right=wheels[..., 1])
    targets = lines("target", arrays.targets)
    trace: pd.DataFrame = pandas.concat([targets, robots]).sort_values(["tick", "kind", "index"], kind="stable", ignore_index=True)
    trace.attrs.update(header)
    return trace
