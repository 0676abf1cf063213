"""JSON of dictionaries that may hold arrays."""

from __future__ import annotations

import json
from typing import Any

import numpy as np


def _plain(value: Any) -> Any:
    if isinstance(value, (np.ndarray, np.generic)):
        return value.tolist()
    raise TypeError(f"{type(value).__name__} has no JSON form")


def dumps(value: Any) -> str:
    """The text, in which numbers that are not finite have no place."""
    return json.dumps(value, default=_plain, allow_nan=False)
