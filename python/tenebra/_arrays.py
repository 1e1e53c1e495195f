"""Turns a caller's numbers into arrays that the module can read in place."""
from __future__ import annotations

from typing import Any, List, Tuple

import numpy as np

from . import _core


def _numbers(name: str, value: Any, dtype: Any) -> np.ndarray:
    array = np.asarray(value)
    if array.dtype.kind not in "fiu":
        raise TypeError(f"{name}: found an array of {array.dtype}, expected numbers")
    return array if array.dtype == dtype else array.astype(dtype)


def _rows(name: str, value: Any, dtype: Any, shape: str = "(n, 3)") -> np.ndarray:
    array = _numbers(name, value, dtype)
    if array.ndim < 1 or array.shape[-1] != 3:
        raise ValueError(f"{name}: found the shape {array.shape}, expected {shape}")
    return np.require(array, requirements=("C", "A"))


def _positions(name: str, value: Any, shape: str = "(n, 3)") -> np.ndarray:
    """Floats stay floats; all else is taken as doubles, so that map coordinates keep their digits."""
    return _rows(name, value, np.float32 if np.asarray(value).dtype == np.float32 else np.float64, shape)


def _indices(name: str, value: Any) -> np.ndarray:
    array = np.asarray(value)
    if array.dtype.kind not in "iu":
        raise TypeError(f"{name}: found an array of {array.dtype}, expected whole numbers")
    if array.dtype != np.uint32:
        if array.size and (array.min() < 0 or array.max() > _core.no_triangle):
            raise ValueError(f"{name}: found numbers from {array.min()} to {array.max()}, expected 0 to {_core.no_triangle}")
        array = array.astype(np.uint32)
    return np.require(array, requirements=("C", "A"))


def _vector(name: str, value: Any) -> List[float]:
    array = _numbers(name, value, np.float64)
    if array.shape != (3,):
        raise ValueError(f"{name}: found the shape {array.shape}, expected 3 numbers")
    if not np.isfinite(array).all():
        raise ValueError(f"{name}: found {array.tolist()}, expected finite numbers")
    return array.tolist()


def _of_each(name: str, array: np.ndarray, shape: Tuple[int, ...]) -> np.ndarray:
    if array.shape != shape:
        raise ValueError(f"{name}: found the shape {array.shape}, expected {shape}")
    return array
