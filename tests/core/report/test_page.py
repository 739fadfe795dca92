"""Reports: what a page says and how numbers read."""

import numpy as np
from lanewright.core.common.features import ROAD_EDGES, Features
from lanewright.core.report.map_figure import draw_map, png
from lanewright.core.report.page import Page, number
from shapely.geometry import LineString


def test_text_from_files_cannot_become_markup():
    page = Page("Survey <b>")
    page.facts([("file", "<script>alert(1)</script>")])
    assert "<script>" not in page.html() and "&lt;script&gt;" in page.html()


def test_a_caption_stays_inside_its_picture():
    page = Page("t")
    page.picture(b"png", 'A "crossing" <i>')
    page.colour_key([("#123456", "kerb & <b>")])
    assert 'alt="A &#34;crossing&#34; &lt;i&gt;"' in page.html() and "kerb &amp; &lt;b&gt;" in page.html()


def test_a_drawing_is_taken_as_it_is():
    page = Page("t")
    page.drawing("<svg><title>a &amp; b</title></svg>", "Heights")
    assert "<p><svg><title>a &amp; b</title></svg></p>" in page.html() and '<p class="note">Heights</p>' in page.html()


def test_numbers_read_well():
    assert number(1234567) == "1\u202f234\u202f567"
    assert number(0.0123) == "0.012"
    assert number(140.04) == "140.0"
    assert number(float("nan")) == "–"


def test_a_table_aligns_numbers_right_and_shows_missing_ones():
    page = Page("t")
    page.table(("Lane", "R (m)"), [("1", 140.0), ("2", None)])
    assert '<td class="number">140.0</td>' in page.html() and "<td>–</td>" in page.html()


def test_an_edge_is_drawn_where_it_lies():
    edges = Features("LineStringZ", ROAD_EDGES)
    edges.add(LineString([(0, 5, 0), (10, 5, 0)]), status="measured")
    image = draw_map({"edges": edges}, bounds=(0, 0, 10, 10), longest=100)
    assert image.shape == (100, 100, 3)
    red = image[:, :, 2].astype(int) - image[:, :, 1]
    assert red[50, 50] > 100 and red[20, 50] < 20
    assert png(image)[:4] == b"\x89PNG"


def test_the_background_lies_under_the_lines_at_its_place():
    grey = np.zeros((10, 10), np.uint8)
    grey[:5] = 200  # northern half
    image = draw_map({}, (grey, (0, 0, 10, 10)), bounds=(0, 0, 10, 10), longest=40)
    assert (image[5, 20] == 200).all() and (image[35, 20] == 28).all()


def test_nothing_to_draw_gives_no_picture():
    assert draw_map({"edges": Features("LineStringZ", ROAD_EDGES)}) is None
