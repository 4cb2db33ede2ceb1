"""Evolve, simulate and run gene-regulatory-network controllers of robot swarms.

Lengths are metres, angles radians, times seconds, unless a name says otherwise. What is refused raises `GrnError`.
"""

from ._evolution import Evolution, evolve
from ._laboratory import laboratory
from ._native import (
    Blob,
    Command,
    Evaluation,
    GrnError,
    Message,
    Progress,
    Robot,
    Scenario,
    TargetReport,
)
from ._native import VERSION as __version__
from ._simulation import Robustness, Simulation, measure, simulate
from ._tables import read_front, read_trace

__all__ = [
    "Blob",
    "Command",
    "Evaluation",
    "Evolution",
    "GrnError",
    "Message",
    "Progress",
    "Robot",
    "Robustness",
    "Scenario",
    "Simulation",
    "TargetReport",
    "__version__",
    "evolve",
    "laboratory",
    "measure",
    "read_front",
    "read_trace",
    "simulate",
]
