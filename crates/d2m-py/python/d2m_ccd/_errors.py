"""The exceptions of the package."""

from __future__ import annotations

from typing import Any


class InputError(ValueError):
    """Bad input: what is wrong, where, and the value found. No query turns an error into "no contact".

    `index` is where it stands (the trial of a batch, the row of an array, a vertex, a triangle, a keyframe, 0 or 1 for
    body A or B) and `value` what was found there; each is `None` where there is none.

    >>> import d2m_ccd
    >>> try:
    ...     d2m_ccd.Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 7]])
    ... except d2m_ccd.InputError as error:
    ...     print(error, error.index, error.value)
    triangle 0: vertex index 7 is out of range, the mesh has 3 vertices 0 7
    """

    index: Any
    value: Any

    def __init__(self, message: str, index: Any = None, value: Any = None) -> None:
        super().__init__(message, index, value)
        self.index = index
        self.value = value

    def __str__(self) -> str:
        return str(self.args[0])
