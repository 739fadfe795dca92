"""The report of a review: what was decided about the doubtful places of a road map, by kind and by person, and what is left."""

from __future__ import annotations

from collections.abc import Sequence

from ...core.common.texts import word
from .page import html_page

ACCEPTED = ("accept", "seen")   # actions that change nothing


def review_report(survey: str, place: str, decided: Sequence[tuple[str, str, str, str, float]],
                  left: Sequence[tuple[str, int, float, float, float, str]]) -> str:
    """The page as HTML.

    place : name of the layer of corrections, "" where there is none yet
    decided : (kind, action, author, when, length in m) of each correction
    left : (kind, road, station, length, m that are likely to be wrong, text) of each piece that nobody has decided about, the most doubtful first
    """
    kinds = []
    for kind in sorted({row[0] for row in decided} | {row[0] for row in left}, key=lambda kind: word(kind, "target")):
        groups = ([row for row in decided if row[0] == kind and row[1] in ACCEPTED],
                  [row for row in decided if row[0] == kind and row[1] not in (*ACCEPTED, "draw")],
                  [row for row in decided if row[0] == kind and row[1] == "draw"])
        waiting = [row for row in left if row[0] == kind]
        kinds.append((word(kind, "target"), *(value for rows in groups for value in (len(rows), sum(row[-1] for row in rows))),
                      len(waiting), sum(row[3] for row in waiting), sum(row[4] for row in waiting)))
    together = [sum(column) for column in zip(*(row[1:] for row in kinds))]
    persons = []
    for author in sorted({row[2] for row in decided}):
        rows = [row for row in decided if row[2] == author]
        accepted = sum(row[1] in ACCEPTED for row in rows)
        persons.append((author or "–", accepted, len(rows) - accepted, min(row[3] for row in rows) or "–", max(row[3] for row in rows) or "–"))
    return html_page("review", survey=survey, place=place, kinds=kinds, together=together, persons=persons,
                     left=[(word(kind, "target"), *row) for kind, *row in left])
