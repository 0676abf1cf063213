"""Trials files."""

from __future__ import annotations

import io
import json
from pathlib import Path

import d2m_ccd
import numpy as np
import pytest
from d2m_ccd import InputError
from d2m_ccd._trials import read_trials, write_results

ROW = [1.0, 0, 0, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9] + [0.0, 1, 0, 0, -1, -2, -3, -4, -5, -6, -7, -8, -9]
LINE = ",".join(str(number) for number in ROW)


def read(folder: Path, text: str) -> object:
    (folder / "t.csv").write_text(text)
    return read_trials(folder / "t.csv")


def test_columns_headers_and_blank_lines(tmp_path: Path) -> None:
    header = ",".join(f"c{k}" for k in range(26))
    trials = read(tmp_path, f"\ufeff\n{header}\n{LINE}\n\n {LINE}\n")
    assert np.hstack([trials.motions_a, trials.motions_b]).tolist() == [ROW, ROW]  # type: ignore[attr-defined]


def test_lines_of_json(tmp_path: Path) -> None:
    form = {"a": {"v": [1, 2, 3]}, "window": [0.5, 1.5]}
    trials = read(tmp_path, f"{json.dumps(form)}\n{LINE}\n")
    assert trials.window.tolist() == [[0.5, 1.5], [0.0, 1.0]]  # type: ignore[attr-defined]
    assert trials.motions_a[0] == d2m_ccd.ConstantTwist(v=[1, 2, 3])  # type: ignore[attr-defined]
    assert trials.motions_b[1] == d2m_ccd.ConstantTwist.from_array(ROW[13:])  # type: ignore[attr-defined]


@pytest.mark.parametrize(
    ("text", "line", "words"),
    [
        ("\n\n", None, "no trials"),
        (f"{LINE}\n1,2,3\n", 2, "found 3"),
        (f"\n{LINE.replace('-4', 'four', 1)}\n", 2, "field 21"),
        (f"{LINE.replace('-9', 'nan')}\n", 1, "finite"),
        ('{"c": {}}\n', 1, "'c'"),
        ('{"a": {"q": [0, 0, 0, 0]}}\n', 1, "orientation"),
        ('{"a": 5}\n', 1, "line 1"),
        ("{\n", 1, "line 1"),
    ],
)
def test_faults_name_the_line(tmp_path: Path, text: str, line: int | None, words: str) -> None:
    with pytest.raises(InputError, match="t.csv") as caught:
        read(tmp_path, text)
    assert caught.value.index == line and words in str(caught.value)


def test_results(box: d2m_ccd.Tree) -> None:
    rows = np.tile([1.0, 0, 0, 0, 5, 0, 0, -8, 0, 0, 0, 0, 0], (2, 1))
    rows[1, 7] = 8
    results = d2m_ccd.batch(box, box, rows)
    file = io.StringIO()
    write_results(file, results, [1.5, 2.5])
    header, contact, separated = file.getvalue().splitlines()
    assert separated == "1,separated,inf,inf,,2.500" + "," * 11
    fields = dict(zip(header.split(","), contact.split(",")))
    assert float(fields["toc"]) == results["time_lo"][0] and fields["evidence"] in ("near", "crossing")
    assert header.count(",") == contact.count(",") == separated.count(",") == 16
