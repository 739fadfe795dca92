"""Tables of numbers in text files, with any header and delimiter.

Half a million rows take about a second: lines are counted and split as bytes, and
the numbers are parsed in one call.
"""

from __future__ import annotations

import io
import os
import re
from collections import Counter
from dataclasses import dataclass

import numpy as np

from ..common.errors import RoadExtractionError

SAMPLE_BYTES = 200_000     # from which the format of the table is recognised
SAMPLE_LINES = 400         # lines of these that are split
MIN_NUMBER_COLUMNS = 3     # columns of numbers that make a table
MAX_NUMBER = 1e20          # beyond time in nanoseconds; larger numbers count as missing, like infinity
FIELDS_PER_CHUNK = 200_000  # fields parsed at a time where some are words
NUMBER_PATTERN = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eEdD][+-]?\d+)?$|[+-]?(nan|inf)$", re.IGNORECASE)
DECIMAL_COMMA_PATTERN = re.compile(r"[+-]?\d+,\d+([eE][+-]?\d+)?$|[+-]?\d+$")
DELIMITERS = (";", "\t", "|", ",", " ")


@dataclass(frozen=True)
class NumberTable:
    """A table of numbers.

    Attributes
    ----------
    values : (N, K) float64, NaN where a field is not a number
    preamble : the lines above the numbers, header included, top down
    first_row : the fields of the first row as they are written
    dropped : rows left out because they had another number of fields
    """

    values: np.ndarray
    preamble: list[str]
    first_row: list[str]
    dropped: int = 0


def read_number_table(path: str | os.PathLike[str]) -> NumberTable:
    """The table of numbers in a text file with any delimiter, with or without a header.

    Parameters
    ----------
    path : of the file, in UTF-8, UTF-16 or an encoding that shares the characters of ASCII

    Returns
    -------
    NumberTable

    Raises
    ------
    RoadExtractionError
        If the file cannot be read, holds no table of at least three columns of
        numbers, or uses the comma for columns and decimals alike.
    """
    data = _text_bytes(path)
    lines = _sample_lines(data)
    delimiter, columns, decimal_comma = _recognise_format(lines, path)
    first = next(k for k, line in enumerate(lines) if _is_row(_fields(line, delimiter), columns, decimal_comma))
    first_row = _fields(lines[first], delimiter)
    if delimiter == ",":
        _refuse_ambiguous_commas(first_row, lines[:first], path)
    body = data.split(b"\n", first)[-1] if first else data
    values, dropped = _parse(body, delimiter, columns, decimal_comma)
    if not len(values):
        raise RoadExtractionError(f"{path} holds no rows of numbers. Check that it is the trajectory and was exported whole.")
    return NumberTable(values, [line for line in lines[:first] if line.strip()], first_row, dropped)


def _text_bytes(path):
    try:
        with open(path, "rb") as file:
            data = file.read()
    except OSError as problem:
        raise RoadExtractionError(f"{path} cannot be read ({problem.strerror or problem}). Check the path and the rights to read it.") from problem
    if data[:2] in (b"\xff\xfe", b"\xfe\xff"):
        data = data.decode("utf-16", "replace").encode()
    data = data[3:] if data.startswith(b"\xef\xbb\xbf") else data
    if b"\0" in data[:SAMPLE_BYTES]:
        raise RoadExtractionError(
            f"{path} is a binary file. A trajectory is read from text (CSV, TXT) or from Applanix SBET (.out, records of 136 bytes).")
    return data.replace(b"\r\n", b"\n").replace(b"\r", b"\n").rstrip(b"\x1a\0 \t\n") + b"\n"


def _sample_lines(data):
    lines = data[:SAMPLE_BYTES].decode("utf-8", "replace").split("\n")
    return lines[:-1]


def _fields(line, delimiter):
    """The fields of one line; a delimiter at its end is ignored."""
    line = line.strip().replace('"', "") if delimiter == " " else line.strip(" ").replace('"', "")
    if delimiter == " ":
        return line.split()
    fields = [field.strip() for field in line.split(delimiter)]
    return fields[:-1] if len(fields) > 1 and not fields[-1] else fields


def _is_number(field, decimal_comma):
    return bool((DECIMAL_COMMA_PATTERN if decimal_comma else NUMBER_PATTERN).match(field))


def _is_row(fields, columns, decimal_comma):
    numbers = sum(_is_number(field, decimal_comma) for field in fields)
    return len(fields) == columns and numbers >= MIN_NUMBER_COLUMNS and 2 * numbers >= len(fields)


def _recognise_format(lines, path):
    """(delimiter, number of columns, decimal comma) that explain the most lines."""
    best = (0, 0, None)
    for rank, delimiter in enumerate(DELIMITERS):
        for decimal_comma in (False, True) if delimiter != "," else (False,):
            rows = []
            for line in lines[:SAMPLE_LINES]:
                fields = _fields(line, delimiter)
                if MIN_NUMBER_COLUMNS <= len(fields) and _is_row(fields, len(fields), decimal_comma):
                    rows.append(len(fields))
            if not rows:
                continue
            columns, count = Counter(rows).most_common(1)[0]
            best = max(best, (count, columns * (not decimal_comma), (-rank, delimiter, columns, decimal_comma)),
                       key=lambda found: found[:2])
    if best[2] is None:
        seen = next((line.strip()[:80] for line in lines if line.strip()), "")
        raise RoadExtractionError(
            f"{path} holds no table of numbers: it begins {seen!r}. A trajectory needs rows with at least x, y and z, "
            "and time where there is one, with a decimal point.")
    return best[2][1:]


def _refuse_ambiguous_commas(first_row, above, path):
    """1,5,2,5 may be two numbers or four."""
    whole = all(re.match(r"[+-]?\d+$", field) for field in first_row)
    padded = any(re.match(r"0\d+$", field) for field in first_row)
    header = next((line.split(",") for line in reversed(above) if line.strip()), [])
    if whole and len(first_row) >= 6 and (padded or 2 * len(header) == len(first_row)):
        raise RoadExtractionError(
            f"{path} uses the comma between columns and as the decimal sign, so its columns cannot be separated. "
            "Export it with a decimal point, or with semicolons between the columns.")


def _parse(body, delimiter, columns, decimal_comma):
    """((N, K) values, number of lines with another number of fields)."""
    body = body.replace(b'"', b"")
    if delimiter != " ":
        body = _fill_empty(body, delimiter.encode())
    table = bytes.maketrans((delimiter + (",Dd" if decimal_comma else "")).encode(),
                            (" " + (".ee" if decimal_comma else "")).encode())
    body = body.translate(table)
    text = np.frombuffer(body, np.uint8)
    ends = np.flatnonzero(text == 10)
    starts = np.r_[0, ends[:-1] + 1]
    space = (text == 32) | (text == 10) | (text == 9)
    begins = ~space & np.r_[True, space[:-1]]
    fields = np.add.reduceat(begins, starts, dtype=np.int64)
    right = fields == columns
    dropped = int(np.count_nonzero(~right & (fields > 0)))
    if not right.all():
        body = text[np.repeat(right, ends - starts + 1)].tobytes()
    rows = int(np.count_nonzero(right))
    values = None
    if rows:
        try:
            values = np.loadtxt(io.BytesIO(body), comments=None, ndmin=2, encoding="latin1")
        except ValueError:
            pass  # a field is not a number: fields are parsed one by one
    if values is None or values.shape != (rows, columns):
        values = _parse_mixed(body, columns)
    return finite_or_nan(values).reshape(-1, columns), dropped


def finite_or_nan(values: np.ndarray) -> np.ndarray:
    """The values, of any shape, with NaN for those that are infinite or beyond MAX_NUMBER, with which sums overflow."""
    return np.where(np.abs(values) < MAX_NUMBER, values, np.nan)


def _fill_empty(body, mark):
    """Write nan into empty fields, and remove a delimiter at the end of a line."""
    body = re.sub(rb"[ ]*" + re.escape(mark) + rb"[ ]*", mark, body) if b" " in body else body
    body = body.replace(mark + b"\n", b"\n")
    for _ in range(2):
        body = body.replace(mark + mark, mark + b"nan" + mark)
    body = body.replace(b"\n" + mark, b"\nnan" + mark)
    body = b"nan" + body if body.startswith(mark) else body
    return body.replace(b" ", b"_")


def _parse_mixed(body, columns):
    """Values of a table in which some fields are words; those become NaN."""
    # bytes.split() would also split at vertical tabs and form feeds, which did not separate the fields above
    fields = re.split(rb"[ \t\n]+", body.strip(b" \t\n"))
    parts = []
    step = FIELDS_PER_CHUNK // columns * columns or columns
    for start in range(0, len(fields), step):
        rows = np.array(fields[start:start + step], dtype=bytes).reshape(-1, columns)
        values = np.empty(rows.shape)
        for column in range(columns):
            try:
                values[:, column] = rows[:, column].astype(float)
            except ValueError:
                values[:, column] = [_number_or_nan(field) for field in rows[:, column]]
        parts.append(values)
    return np.concatenate(parts) if parts else np.empty((0, columns))


def _number_or_nan(field):
    try:
        return float(field.replace(b"D", b"e").replace(b"d", b"e"))
    except ValueError:
        return np.nan
