"""Reports: what a page says and how numbers read."""

import numpy as np
import pytest
from jinja2 import UndefinedError
from lanewright.core.common.features import ROAD_EDGES, Features
from lanewright.core.pipeline.road_map import STAGE_NAMES
from lanewright.products.report.page import draw_map, html_page, number, templates
from shapely.geometry import LineString


def page(content, **values):
    """A page whose template holds only some content."""
    template = '{% extends "page.html" %}{% block content %}' + content + "{% endblock %}"
    return templates().from_string(template).render({"title": "Survey", **values})


def test_text_from_files_cannot_become_markup():
    text = page('{{ facts([("file", name)]) }}', title="Survey <b>", name="<script>alert(1)</script>")
    assert "<script>" not in text and "&lt;script&gt;" in text and "<h1>Survey &lt;b&gt;</h1>" in text


def test_a_caption_stays_inside_its_picture():
    text = page("{{ picture(image, caption) }}{{ colour_key(colours) }}", image=np.zeros((2, 2, 3), np.uint8), caption='A "crossing" <i>',
                colours=[("#123456", "kerb & <b>")])
    assert 'alt="A &#34;crossing&#34; &lt;i&gt;" src="data:image/png;base64,iVBORw0' in text and "kerb &amp; &lt;b&gt;" in text


def test_a_drawing_is_taken_as_it_is():
    text = page("{{ drawing(svg, 'Heights') }}", svg="<svg><title>a &amp; b</title></svg>")
    assert "<p><svg><title>a &amp; b</title></svg></p>" in text and '<p class="note">Heights</p>' in text
    assert "Heights" not in page("{{ drawing('', 'Heights') }}")


def test_numbers_read_well():
    assert number(1234567) == "1\u202f234\u202f567"
    assert number(0.0123) == "0.012"
    assert number(140.04) == "140.0"
    assert number(float("nan")) == "–"


def test_a_table_aligns_numbers_right_and_shows_missing_ones():
    text = page('{{ table(["Lane", "R (m)", "n"], [("1", 140.0, 3), ("2", none, 4)], [none, 2]) }}')
    assert '<th>Lane</th><th class="number">R (m)</th>' in text
    assert '<td>1</td><td class="number">140.00</td><td class="number">3</td>' in text and "<td>–</td>" in text


def test_a_page_that_lacks_a_value_is_not_written():
    with pytest.raises(UndefinedError, match="report"):
        html_page("intensity_correction")


@pytest.mark.parametrize("status", ["measured", "bridged", "inferred"])
def test_an_edge_is_drawn_where_it_lies(status):
    edges = Features("LineStringZ", ROAD_EDGES)
    edges.add(LineString([(0, 5, 0), (10, 5, 0)]), status=status)
    image = draw_map({"edges": edges}, bounds=(0, 0, 10, 10), longest=100)
    assert image.shape == (100, 100, 3)
    red = image[:, :, 2].astype(int) - image[:, :, 1]
    assert red[50, 50] > 100 and red[20, 50] < 20


def test_the_background_lies_under_the_lines_at_its_place():
    grey = np.zeros((10, 10), np.uint8)
    grey[:5] = 200  # northern half
    image = draw_map({}, (grey, (0, 0, 10, 10)), bounds=(0, 0, 10, 10), longest=40)
    assert (image[5, 20] == 200).all() and (image[35, 20] == 28).all()


def test_nothing_to_draw_gives_no_picture():
    assert draw_map({"edges": Features("LineStringZ", ROAD_EDGES)}) is None


def test_each_stage_of_a_road_map_has_a_name_in_its_report():
    source = templates().loader.get_source(templates(), "road_map.html")[0]
    assert [name for name in STAGE_NAMES if f'{name}=tr("' not in source] == []
