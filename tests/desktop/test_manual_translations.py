"""The manual in other languages: generated pages up to date, pages written by hand paragraph by paragraph beside the English ones."""

import json
import re
import subprocess
import sys
from pathlib import Path

import pytest
from lanewright.algorithms.catalogue import ALGORITHMS
from lanewright.algorithms.texts import TRANSLATIONS
from lanewright.desktop.menu import PAGES, page_path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tools"))

import manual_translations as translations  # noqa: E402
from make_manual import LANGUAGES, WRITTEN_BY_HAND  # noqa: E402

BY_HAND = [(language, name) for language in LANGUAGES for name in WRITTEN_BY_HAND]


def generated():
    return {f"{algorithm.ID}.md" for algorithm in ALGORITHMS} | {"index.md"}


@pytest.mark.parametrize("language", LANGUAGES)
def test_the_pages_of_algorithms_say_what_the_translated_dialogs_say(language, tmp_path):
    """Made by a program of its own, since texts are translated when they are imported."""
    subprocess.run([sys.executable, ROOT / "tools" / "make_manual.py", tmp_path, language], check=True, capture_output=True)
    made = {path.name: path.read_text(encoding="utf-8") for path in tmp_path.glob("*.md")}
    assert set(made) == generated()
    kept = {path.name: path.read_text(encoding="utf-8") for path in (PAGES / language).glob("*.md")}
    stale = [name for name, text in made.items() if kept.get(name) != text]
    assert not stale, "run make manual"


@pytest.mark.parametrize("language", LANGUAGES)
def test_every_page_is_there_in_every_language_and_none_besides(language):
    assert {path.name for path in (PAGES / language).glob("*.md")} == generated() | {f"{name}.md" for name in WRITTEN_BY_HAND}


@pytest.mark.parametrize(("language", "name"), BY_HAND)
def test_no_paragraph_changed_without_its_translation_being_looked_at(language, name):
    assert not translations.out_of_step(name, language)
    assert not translations.stale(name, language), "run tools/manual_translations.py"


@pytest.mark.parametrize(("language", "name"), BY_HAND)
def test_commands_are_the_same_in_every_language(language, name):
    """But for what a comment says."""
    def commands(paragraphs):
        return [re.sub(r"\s+# .*|\"error\": .*", "", paragraph) for paragraph in paragraphs if translations.kind(paragraph) == "code"]

    assert commands(translations.page(name)) == commands(translations.page(name, language))


@pytest.mark.parametrize(("language", "name"), BY_HAND)
def test_what_stands_on_buttons_and_in_lists_is_called_as_the_translated_plugin_calls_it(language, name):
    words = json.loads((TRANSLATIONS / f"lanewright_{language}.json").read_text(encoding="utf-8"))
    for here, there in zip(translations.page(name), translations.page(name, language)):
        there = " ".join(there.split())
        for named in re.findall(r"(?<!\*)\*([^*]+)\*(?!\*)", " ".join(here.split())):
            for part in named.split(" → "):
                assert words.get(part, "") in there, f"{part}: {words[part]}"


@pytest.mark.parametrize("language", LANGUAGES)
def test_links_and_pictures_lead_somewhere_and_stay_in_the_language(language):
    for page in (PAGES / language).glob("*.md"):
        for target, anchor in re.findall(r"\]\(([^)#]+)(#[^)]+)?\)", page.read_text(encoding="utf-8")):
            if target.startswith("http"):
                continue
            found = (page.parent / target).resolve()
            assert found.exists(), f"{page.name}: {target}"
            if anchor:
                headings = re.findall(r"^#+ (.+)$", found.read_text(encoding="utf-8"), re.M)
                assert anchor[1:] in {re.sub(r"[^\w -]", "", heading).lower().replace(" ", "-") for heading in headings}, f"{page.name}: {anchor}"
            if found.suffix == ".md" and found.parent == PAGES:
                assert page.name == "index.md" and found.name == "index.md", f"{page.name} leads to the English page {found.name}"


def test_the_troubleshooting_quotes_what_is_said_in_german():
    said = (TRANSLATIONS / "core_de.json").read_text(encoding="utf-8") + (TRANSLATIONS / "lanewright_de.json").read_text(encoding="utf-8")
    for message in re.findall(r"^### (.+)$", (PAGES / "de" / "troubleshooting.md").read_text(encoding="utf-8"), re.M):
        for part in (part.strip(" .") for part in message.split("…")):
            assert part in said, f"{message}: {part}"


def test_a_page_opens_in_the_language_of_qgis_in_english_without_one_and_at_the_contents_where_there_is_none():
    assert page_path("detectcurbs", "de_AT") == PAGES / "de" / "detectcurbs.md"
    assert page_path("detectcurbs", "fr") == page_path("detectcurbs", "en") == PAGES / "detectcurbs.md"
    assert page_path("no such page", "de") == PAGES / "de" / "index.md"


# -- the tool itself ------------------------------------------------------------------------------------


def test_a_paragraph_is_changed_by_its_words_and_not_by_where_its_lines_break():
    one, broken, other = "Curbs are found.", "Curbs\nare   found.", "Curbs are drawn."
    assert translations.checksum(one) == translations.checksum(broken) != translations.checksum(other)


def test_a_block_of_code_is_one_paragraph_with_its_empty_lines():
    text = "# Title\n\nWords.\n```\na\n\nb\n```\n\n- one\n- two\n"
    assert [translations.kind(paragraph) for paragraph in translations.paragraphs(text)] == ["#", "text", "code", "list of 2"]


def test_a_changed_an_added_and_a_missing_paragraph_are_told_and_seen(tmp_path, monkeypatch):
    monkeypatch.setattr(translations, "PAGES", tmp_path)
    monkeypatch.setattr(translations, "WRITTEN_BY_HAND", ("curbs",))
    (tmp_path / "de").mkdir()
    english, german = tmp_path / "curbs.md", tmp_path / "de" / "curbs.md"
    english.write_text("# Curbs\n\nThey are high.\n", encoding="utf-8")
    german.write_text("# Bordsteine\n\nAlles hoch.\n", encoding="utf-8")
    assert len(translations.stale("curbs", "de")) == 2
    translations.seen(["curbs"], "de")
    assert not translations.stale("curbs", "de") and not translations.out_of_step("curbs", "de")

    english.write_text("# Curbs\n\nThey are low.\n", encoding="utf-8")
    assert translations.stale("curbs", "de") == [(2, "They are low.", "Alles hoch.")]

    english.write_text("# Curbs\n\nThey are high.\n\n## More\n", encoding="utf-8")
    assert "paragraph 3" in translations.out_of_step("curbs", "de")
    with pytest.raises(SystemExit, match="step"):
        translations.seen(["curbs"], "de")
