"""A trace's flat arrays in their shapes and in SI units."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt


NOT_THERE = np.iinfo(np.int32).min
"""Stands for both coordinates of a target that is not there."""


class Arrays:
    """As `Simulation` describes them; `header` holds what the trace is of."""

    def __init__(self, flat: dict[str, Any]) -> None:
        def shaped(name: str, dtype: str, *shape: int) -> Any:
            return np.frombuffer(flat.pop(name), dtype=dtype).reshape(flat["frames"], *shape)

        robots, targets = flat["robots"], flat["targets"]
        self.positions: npt.NDArray[np.float64] = shaped("positions_um", "<i4", robots, 2) * 1e-6
        places = shaped("targets_um", "<i4", targets, 2)
        self.targets: npt.NDArray[np.float64] = np.where(places == NOT_THERE, np.nan, places * 1e-6)
        cos_sin = shaped("headings_q14", "<i2", robots, 2).astype(float)
        self.headings: npt.NDArray[np.float64] = np.arctan2(cos_sin[..., 1], cos_sin[..., 0])
        self.wheels: npt.NDArray[np.int16] = shaped("wheels", "<i2", robots, 2)
        self.contacts: npt.NDArray[np.uint32] = shaped("contacts", "<u4", 4)
        self.times: npt.NDArray[np.float64] = np.arange(flat["frames"]) * flat["ticks_per_frame"] / flat["ticks_per_second"]
        self.header = flat
