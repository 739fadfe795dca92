"""CONTRIBUTING sends a newcomer to folders and functions that there are."""

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
TEXT = (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8")
WHERE = re.search(r"^## Where would I mend.*?(?=^## )", TEXT, re.M | re.S).group()
ANSWERS = [[cell.strip() for cell in line[1:-1].split("|")] for line in WHERE.splitlines() if line.startswith("| ") and "`" in line]


def defined_in(folders):
    code = "\n".join(path.read_text(encoding="utf-8") for folder in folders for path in sorted((ROOT / folder).rglob("*.py")))
    return set(re.findall(r"^(?:def|class) (\w+)", code, re.M))


def test_at_least_twenty_questions_are_answered():
    assert len(ANSWERS) >= 20


@pytest.mark.parametrize(("question", "folders", "functions"), ANSWERS, ids=[answer[0][:40] for answer in ANSWERS])
def test_each_answer_names_a_folder_and_functions_that_are_in_it(question, folders, functions):
    folders = re.findall(r"`([\w/]+)`", folders)
    assert folders and all((ROOT / folder).is_dir() for folder in folders)
    assert not set(re.findall(r"`(\w+)`", functions)) - defined_in(folders)


def test_what_flows_is_what_the_chain_calls():
    chain = "".join(path.read_text(encoding="utf-8") for path in (ROOT / "core" / "pipeline").glob("*.py"))
    drawn = re.search(r"^## What flows.*?^```\n(.*?)^```", TEXT, re.M | re.S).group(1)
    stages = re.findall(r"[a-z]+_[a-z_]+", drawn)
    assert len(stages) >= 9 and all(re.search(rf"\b{stage}\b", chain) for stage in stages)
