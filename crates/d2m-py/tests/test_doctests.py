"""Every public name has a docstring with an example, and every example is right."""

from __future__ import annotations

import doctest
import inspect
from typing import Any

import d2m_ccd
import pytest

#: Fields that every answer has speak for themselves: an example of the class shows them.
CLASSES_WITH_EXAMPLES_OF_THEIR_OWN = [name for name in d2m_ccd.__all__ if inspect.isclass(getattr(d2m_ccd, name))]


def examples() -> list[tuple[str, str]]:
    found = [("d2m_ccd", d2m_ccd.__doc__ or "")]
    for name in d2m_ccd.__all__:
        thing = getattr(d2m_ccd, name)
        if inspect.isclass(thing):
            found.append((name, inspect.getdoc(thing) or ""))
            for member, value in vars(thing).items():
                doc = getattr(value, "__doc__", None)
                if not member.startswith("_") and isinstance(doc, str) and ">>>" in doc:
                    found.append((f"{name}.{member}", inspect.cleandoc(doc)))
        elif callable(thing):
            found.append((name, inspect.getdoc(thing) or ""))
    return found


@pytest.mark.parametrize(("name", "doc"), examples(), ids=[name for name, _ in examples()])
def test_example(name: str, doc: str) -> None:
    assert ">>>" in doc, f"{name} has no example"
    test = doctest.DocTestParser().get_doctest(doc, {}, name, None, 0)
    report: list[str] = []
    doctest.DocTestRunner(optionflags=doctest.NORMALIZE_WHITESPACE).run(test, out=report.append)
    assert not report, "".join(report)


def test_every_public_member_is_documented() -> None:
    without = []
    for name in CLASSES_WITH_EXAMPLES_OF_THEIR_OWN:
        members: dict[str, Any] = vars(getattr(d2m_ccd, name))
        for member, value in members.items():
            public = not member.startswith("_") and (callable(value) or hasattr(value, "__get__"))
            if public and not (getattr(value, "__doc__", None) or "").strip():
                without.append(f"{name}.{member}")
    assert without == []
