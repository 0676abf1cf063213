"""Trials files and result files of the command line (`d2m batch`)."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any, TextIO

import numpy as np

from ._d2m import Motion, feature_text
from ._errors import InputError
from ._records import Evidence, Status

_HEADER = (
    "trial,status,toc,toc_hi,separation,microseconds,normal_x,normal_y,normal_z,"
    "point_x,point_y,point_z,feature,triangle_a,triangle_b,evidence,tolerance"
)


@dataclass(frozen=True)
class Trials:
    """What `batch` takes: motions of A and of B, and windows."""

    motions_a: Any
    motions_b: Any
    window: Any

    def __len__(self) -> int:
        return len(self.motions_a)

    def part(self, start: int, end: int) -> Trials:
        """The trials from `start` to before `end`."""
        window = self.window
        if window is not None and np.ndim(window) == 2:
            window = window[start:end]
        return Trials(_part(self.motions_a, start, end), _part(self.motions_b, start, end), window)


def _part(motions: Any, start: int, end: int) -> Any:
    if isinstance(motions, (list, tuple)) or hasattr(motions, "__getitem__") and not isinstance(motions, dict):
        return motions[start:end]
    return motions


def read_trials(path: str | Path) -> Trials:
    """The trials of a file: 26 numbers a line, qA(w,x,y,z), xA, vA, wA and those of B, or a line of JSON each.

    A header line and blank lines are skipped. Raises `InputError` with the line, from 1, as `index`.
    """
    with open(path, encoding="utf-8-sig") as file:
        lines = [(number, line) for number, line in enumerate(file, 1) if line.strip()]
    if lines and _is_header(lines[0][1]):
        del lines[0]
    if not lines:
        raise InputError(f"{path}: there are no trials")
    if any(line.lstrip().startswith("{") for _, line in lines):
        return _of_json(path, lines)
    rows = np.empty((len(lines), 26))
    for row, (number, line) in zip(rows, lines):
        row[:] = _numbers(path, number, line)
    return Trials(rows[:, :13], rows[:, 13:], None)


def _is_header(line: str) -> bool:
    if "," not in line or line.lstrip().startswith("{"):
        return False
    return all(_number(field) is None for field in line.split(","))


def _number(field: str) -> float | None:
    try:
        return float(field)
    except ValueError:
        return None


def _numbers(path: str | Path, number: int, line: str) -> list[float]:
    fields = line.split(",")
    if len(fields) != 26:
        raise InputError(f"{path}, line {number}: expected 26 numbers separated by commas, found {len(fields)}", number)
    values = []
    for place, field in enumerate(fields, 1):
        value = _number(field)
        if value is None or not np.isfinite(value):
            wanted = "a number" if value is None else "finite"
            raise InputError(f"{path}, line {number}: field {place}: {field.strip()!r} is not {wanted}", number, field.strip())
        values.append(value)
    return values


def _of_json(path: str | Path, lines: list[tuple[int, str]]) -> Trials:
    motions_a: list[Motion] = []
    motions_b: list[Motion] = []
    windows = np.empty((len(lines), 2))
    for place, (number, line) in enumerate(lines):
        try:
            if line.lstrip().startswith("{"):
                form = json.loads(line)
                unknown = set(form) - {"a", "b", "window"}
                if unknown:
                    raise InputError(f"unknown key {sorted(unknown)[0]!r}")
                texts = [json.dumps(form.get(body, {})) for body in ("a", "b")]
                windows[place] = form.get("window", [0.0, 1.0])
            else:
                row = _numbers(path, number, line)
                keys = (("q", 0, 4), ("x", 4, 7), ("v", 7, 10), ("w", 10, 13))
                texts = [json.dumps({key: row[at + start : at + end] for key, start, end in keys}) for at in (0, 13)]
                windows[place] = [0.0, 1.0]
            for motions, text in zip((motions_a, motions_b), texts):
                motions.append(Motion.from_json(text))
        except (ValueError, TypeError) as error:
            message = str(error)
            where = f"{path}, line {number}: "
            raise InputError(message if message.startswith(where) else where + message, number) from error
    return Trials(motions_a, motions_b, windows)


def write_results(file: TextIO, results: Any, microseconds: Any = None, *, first: int = 0, header: bool = True) -> None:
    """Writes results as `d2m batch` does, numbers with 17 digits. `microseconds` a trial may be left out."""
    if header:
        file.write(_HEADER + "\n")
    for place, row in enumerate(results):
        file.write(_line(first + place, row, None if microseconds is None else float(microseconds[place])) + "\n")


def _line(trial: int, row: Any, microseconds: float | None) -> str:
    took = "" if microseconds is None else f"{microseconds:.3f}"
    status = Status(int(row["status"]))
    if status is Status.SEPARATED:
        return f"{trial},separated,inf,inf,,{took},,,,,,,,,,,"
    if status is Status.UNDECIDED:
        return f"{trial},undecided,{row['time_lo']:.16e},inf,,{took},,,,,,,,,,,"
    numbers = [row["time_lo"], row["time_hi"], row["separation"]]
    vectors = [*row["normal"], *row["point_a"]]
    features = feature_text(int(row["feature_kind"]), row["features"].tolist())
    return ",".join(
        [
            f"{trial},contact",
            *(f"{number:.16e}" for number in numbers),
            took,
            *(f"{number:.16e}" for number in vectors),
            f"{features},{row['triangle_a']},{row['triangle_b']}",
            f"{Evidence(int(row['evidence'])).name.lower()},{row['tolerance']:.16e}",
        ]
    )
