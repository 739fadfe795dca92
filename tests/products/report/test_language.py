"""Reports in the user's language: no text goes past the translation, names and numbers of the data do."""

import ast
import re
from pathlib import Path

import pytest
from jinja2 import nodes
from lanewright.core.common.texts import set_translation, word
from lanewright.products.assess.layers import boundary_layer
from lanewright.products.assess.lines import assess_boundaries
from lanewright.products.export.check.findings import FAULTS, Finding, Findings
from lanewright.products.report.assessment import boundary_report
from lanewright.products.report.hd_map import map_check_report
from lanewright.products.report.page import templates
from shapely.geometry import LineString

FOLDER = Path(__file__).resolve().parents[3] / "products" / "report"
FIGURES = sorted(path for path in FOLDER.glob("*.py") if path.stem not in ("__init__", "page"))
# Calls whose texts stand in a figure; those whose texts were translated
SHOWN = {"Chart", "level", "curve", "bars"}
TRANSLATED = {"tr", "told", "word", "_kind_name"}
MADE_OF_LETTERS = re.compile(r"[a-z]{3,}|[A-Za-z]{4,}")
NAMES = {"gps_time", "RMSE (cm)", "RMSE (m)", "RMSE", "xyz"}  # the same in all languages
FIELDS = {"mean", "median", "of_a_point", "largest"}


@pytest.fixture
def marked():
    """Every text that was translated stands in brackets."""
    set_translation(lambda text: f"⟦{text}⟧", lambda text: f"⟦{text}⟧", "de")
    yield
    set_translation(None)


def name_of(call):
    return call.func.id if isinstance(call.func, ast.Name) else call.func.attr if isinstance(call.func, ast.Attribute) else ""


def untranslated(node):
    """The texts below a node that nothing translates; keys and comparisons are none."""
    if isinstance(node, ast.Call) and name_of(node) in TRANSLATED or isinstance(node, (ast.Subscript, ast.Compare)):
        return
    if isinstance(node, ast.Constant) and isinstance(node.value, str):
        yield node.value
    for inner in ast.iter_child_nodes(node):
        if not (isinstance(node, ast.FormattedValue) and inner is node.format_spec):
            yield from untranslated(inner)


@pytest.mark.parametrize("path", FIGURES, ids=lambda path: path.stem)
def test_every_text_in_a_figure_is_translated(path):
    found = {}
    for call in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(call, ast.Call) and name_of(call) in SHOWN:
            for argument in (*call.args, *(keyword.value for keyword in call.keywords)):
                found |= {text: call.lineno for text in untranslated(argument) if MADE_OF_LETTERS.search(text)}
    assert not {text: line for text, line in found.items() if text not in NAMES and not text.startswith("#")}


@pytest.mark.parametrize("path", sorted((FOLDER / "templates").glob("*.html")), ids=lambda path: path.stem)
def test_every_text_of_a_template_is_translated(path):
    """What stands between tags, and the constants that a template shows: in lists, as cells of a table, as a value of its own."""
    tree = templates().parse(path.read_text(encoding="utf-8"))
    found = re.findall(r">([^<>]+)<", re.sub(r"(?s)<style>.*?</style>", "", "".join(part.data for part in tree.find_all(nodes.TemplateData))))
    for output in (*tree.find_all(nodes.Output), *tree.find_all(nodes.CallBlock), *tree.find_all(nodes.Assign)):
        found += untranslated_of_template(output)
    assert not [text for text in found if MADE_OF_LETTERS.search(text) and text not in NAMES | FIELDS and not text.startswith("#")]


def untranslated_of_template(node):
    """As `untranslated`, of a template; names of fields for `pick` are no texts."""
    if isinstance(node, nodes.Call) and isinstance(node.node, nodes.Name) and node.node.name in {"tr", "told", "word", "pick", "dict"} \
            or isinstance(node, (nodes.Getitem, nodes.Compare)):
        return
    if isinstance(node, nodes.Const) and isinstance(node.value, str):
        yield node.value
    for inner in node.iter_child_nodes():
        yield from untranslated_of_template(inner)


def texts_of(page):
    """What a reader sees."""
    return re.findall(r">([^<>]+)<", re.sub(r"(?s)<style>.*?</style>|<img[^>]*>", "", page))


def test_a_report_shows_no_english_but_names(marked):
    curb = LineString([(0, 0, 1), (20, 0, 1)])
    accuracy = assess_boundaries([curb], [curb, LineString([(30, 0, 1), (50, 0, 1)])])
    page = boundary_report(accuracy, boundary_layer(accuracy, ""), ("Mine", "Truth"), ["A warning."])
    bare = {re.sub(r"⟦[^⟧]*⟧", "", text) for text in texts_of(re.sub(r"(?s)⟦[^⟦⟧]*⟦[^⟦⟧]*⟧[^⟦⟧]*⟧", "", page))}
    assert not {text for text in bare if MADE_OF_LETTERS.search(text)} - {"RMSE (cm)", "RMSE"}
    assert '<html lang="de">' in page and "⟦A warning.⟧" in page


def test_a_report_is_english_and_says_so_where_nothing_translates():
    page = map_check_report(Findings([Finding("gap", "road 1", "There are 2 m.", (0.0, 0.0, 0.0))]), "a/map.xodr")
    assert '<html lang="en">' in page and "⟦" not in page and FAULTS["gap"] in page


def test_values_of_fields_are_words_of_the_language_names_stay(marked):
    assert word("bridged") == "⟦bridged⟧" and word("occluded") == "⟦hidden⟧"
    assert word("edge", "class") == "⟦Edge line⟧" and word("edge", "target") == "⟦road edge⟧"
    assert word("B12") == "B12" and word(None) == word("") == "–"


def test_values_of_fields_stand_in_english_reports_as_they_stand_in_the_layers():
    assert word("side_street") == "side_street" and word("edge", "class") == "edge"
