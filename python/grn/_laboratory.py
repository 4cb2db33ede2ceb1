"""Laboratories: the conditions that robots work under."""

from __future__ import annotations

import json
from os import PathLike, fspath
from typing import Any, Mapping, Union

from . import _native


def laboratory(lab: Union[str, PathLike[str]], *, set: Mapping[str, object] = {}) -> dict[str, Any]:
    """The numbers of a laboratory by table and key, as `grn lab NAME` tells them.

    Args:
        lab: the name of one that is shipped, or the path of a file.
        set: values to replace, such as `{"radio.loss": 0.3}`.
    """
    numbers: dict[str, Any] = json.loads(_native.laboratory_json(fspath(lab), assignments(set)))
    return numbers


def assignments(changes: Mapping[str, object]) -> list[str]:
    """As the command line has them: `radio.loss=0.3`."""
    return [f"{key}={str(value).lower() if isinstance(value, bool) else value}" for key, value in changes.items()]
