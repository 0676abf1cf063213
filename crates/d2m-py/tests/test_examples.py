"""The examples do what they say."""

from __future__ import annotations

import importlib.util
from pathlib import Path
from typing import Any

import pytest

EXAMPLES = Path(__file__).parent.parent / "examples"


def load(name: str) -> Any:
    import sys

    spec = importlib.util.spec_from_file_location(name, EXAMPLES / f"{name}.py")
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules[name] = module
    spec.loader.exec_module(module)
    return module


def test_edges_of_a_planner() -> None:
    through, against = load("ompl_motion_validator").example()
    assert through.is_free and through.last_valid == 1.0
    # The drone's nose is 0.2 ahead, further when it turns, and the wall begins at 2 - 0.001 - 0.01.
    assert not against.is_free and 0.42 < against.last_valid < (2 - 0.011 - 0.2) / 4


def test_a_trajectory_of_joints() -> None:
    beside, through = load("joint_trajectory").example()
    assert beside.status == "separated"
    assert through.status == "contact" and through.b is not None and through.b.name == "shelf"
    assert 0.0 < through.clear_until < 2.5
    assert through.contact.time_lo == pytest.approx(through.clear_until)
