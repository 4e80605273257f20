"""Recorded structs as numpy arrays: bytes laid end to end are read where they are, nothing is rounded."""

from __future__ import annotations

from functools import cache
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from . import _native


@cache
def dtype_of(which: Literal["state", "outputs"]) -> np.dtype[np.void]:
    """The type of today's state or outputs."""
    return np.dtype(_native.Flight.fields(which))


def rows(fields: list[tuple[str, str]], data: bytes) -> NDArray[np.void]:
    """A row a message."""
    found: NDArray[np.void] = np.frombuffer(data, dtype=np.dtype(fields))
    return found


def row(which: Literal["state", "outputs"], data: bytes) -> np.void:
    """One message."""
    found: np.void = np.frombuffer(data, dtype=dtype_of(which))[0]
    return found
