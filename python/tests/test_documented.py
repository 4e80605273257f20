"""The examples of docs/python.md run as they stand there."""

from __future__ import annotations

import doctest
import re

import pytest
from conftest import ROOT

import tiltrotor.flight
import tiltrotor.gym

PAGE = (ROOT / "docs/python.md").read_text()
EXAMPLES = re.findall(r"^```python\n(.*?)^```$", PAGE, re.DOTALL | re.MULTILINE)


def test_there_are_ten():
    assert len(EXAMPLES) == len(re.findall(r"^\*\*\d+\. ", PAGE, re.MULTILINE)) == 10


def test_the_examples_run_one_after_another(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    names: dict[str, object] = {}
    for number, example in enumerate(EXAMPLES, start=1):
        exec(compile(example, f"docs/python.md, example {number}", "exec"), names)
    assert capsys.readouterr().out.count("\n") > 30


@pytest.mark.parametrize("module", [tiltrotor, tiltrotor.flight, tiltrotor.gym], ids=lambda m: m.__name__)
def test_what_docstrings_show_is_so(module):
    failed, tried = doctest.testmod(module)
    assert (failed, tried > 0) == (0, True)
