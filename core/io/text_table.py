"""Tables of numbers in text files, with any header and delimiter.

Half a million rows take about a second: lines are counted and split as bytes, and
the numbers are parsed in one call. How people write numbers is one table, STYLES.
"""

from __future__ import annotations

import csv
import io
import os
import re
from collections import Counter
from contextlib import suppress
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np

from ..common.errors import RoadExtractionError
from .weights import IO

DELIMITERS = (";", "\t", "|", ",", " ")
MIXED = re.compile(rb"[ ]*[,;|\t ][ ]*")                # between columns where a row has several delimiters
# Encodings of tables beside UTF-8, and what words beyond ASCII are in them. Latin letters in these bytes stand beside small letters of ASCII.
_EAST_ASIA = re.compile("[\u3000-\u30ff\u4e00-\u9fff\uac00-\ud7a3\uff00-\uff60°℃㎡]+")
_CYRILLIC = re.compile("[а-яёіїєґў]{2,}|[А-ЯЁІЇЄҐЎ][а-яёіїєґў]+|[А-ЯЁІЇЄҐЎ]{2,}|[°№]")
ENCODINGS = (("gb2312", _EAST_ASIA), ("cp932", _EAST_ASIA), ("cp949", _EAST_ASIA), ("gb18030", _EAST_ASIA), ("cp1251", _CYRILLIC))
UNIT_SUFFIX = r"(?: ?(?:m|cm|mm|km|s|sec|ms|us|ns|ft|deg|rad|gon|°))?"
# What stands for a number without being one: dates, clock times, degrees with minutes and seconds
VALUE_PATTERN = re.compile(r"\d{1,4}[-/.]\d{1,2}[-/.]\d{1,4}([ T]\d{1,2}:.*)?$|\d{4} ?年.*[日时時分秒\d]$|"
                           r"\d{1,2}:\d{2}(:\d{2}([.,]\d*)?)?( ?[ap]\.?m\.?)?(Z|[+-]\d{2}:?\d{2})?$|"
                           r"[NSEW]? ?[+-]?\d{1,3} ?[°dº:] ?\d{1,2}|[NSEW]? ?[+-]?\d{1,3} \d{1,2}[ .]\d{1,2}([.,]\d*)? ?[NSEW]?$", re.IGNORECASE)


@dataclass(frozen=True)
class _NumberStyle:
    """How numbers are written: the decimal sign, and the sign between groups of three digits, "" for none."""

    decimal: str
    grouping: str = ""

    @cached_property
    def number(self) -> re.Pattern[str]:
        """Matches a field that is a number."""
        point, mark = re.escape(self.decimal), re.escape(self.grouping)
        digits = rf"\d{{1,3}}(?:{mark}\d{{3}})+|\d+" if mark else r"\d+"
        exponent = "[eEdD]" if self.decimal == "." else "[eE]"
        return re.compile(rf"[+-]?(?:(?:{digits})(?:{point}\d*)?|{point}\d+)(?:{exponent}[+-]?\d+)?{UNIT_SUFFIX}$|[+-]?(?:nan|inf)$", re.IGNORECASE)

    @cached_property
    def grouped(self) -> re.Pattern[str]:
        """Matches a text with a number that is written in groups beyond doubt: 2'710'159 or 610.475,8 but not 610.475."""
        point, mark = re.escape(self.decimal), re.escape(self.grouping)
        return re.compile(rf"(?<![\d.,])\d{{1,3}}(?:{mark}\d{{3}})+(?:{mark}\d{{3}}|{point}\d+)(?![\d.,])")


STYLES = (_NumberStyle("."), _NumberStyle(","), _NumberStyle(".", "'"), _NumberStyle(",", "'"), _NumberStyle(".", " "), _NumberStyle(",", " "),
          _NumberStyle(",", "."), _NumberStyle(".", ","))


@dataclass(frozen=True)
class NumberTable:
    """A table of numbers.

    preamble, first_row : the lines above the numbers, header included, top down, and the fields of the first row as they are written
    """

    values: np.ndarray   # (N, K) float64, NaN where a field is not a number
    preamble: list[str]
    first_row: list[str]
    dropped: int = 0   # rows left out because they had another number of fields
    body: bytes = field(default=b"", repr=False)   # the rows, their fields separated by blanks, with _ for a blank within a field

    @cached_property
    def _fields(self):
        # bytes.split() would also split at vertical tabs and form feeds, which did not separate the fields above
        return re.split(rb"[ \t\n]+", self.body.strip(b" \t\n"))

    def texts(self, column: int) -> list[str]:
        """The N fields of a column as they are written, "" where one is empty."""
        return ["" if text == b"nan" else _decoded(text).replace("_", " ") for text in self._fields[column::self.values.shape[1]]]


def read_number_table(path: str | os.PathLike[str]) -> NumberTable:
    """The table of numbers in a text file with any delimiter, with or without a header, in UTF-8, UTF-16 or another encoding like ASCII.

    Raises RoadExtractionError if the file cannot be read, holds no table of at least three columns of numbers, or uses the comma for columns and
    decimals alike.
    """
    data = _without_quotes(_text_bytes(path))
    lines = _sample_lines(data)
    recognised = _recognise_format(lines)
    if recognised is None:
        data = MIXED.sub(b" ", data)
        mixed = _sample_lines(data)
        recognised = _recognise_format(mixed)
        if recognised is None:
            first_line = next((line.strip()[:80] for line in lines if line.strip()), "")
            raise RoadExtractionError(f"{path} holds no table of numbers: it begins {first_line!r}. A trajectory needs rows with at least x, y and "
                                      "z, and time where there is one, with a decimal point.")
        lines = mixed
    delimiter, columns, style = recognised
    first = next(k for k, line in enumerate(lines) if _is_row(_fields(line, delimiter), columns, style))
    first_row = _fields(lines[first], delimiter)
    if delimiter == ",":
        _refuse_ambiguous_commas(first_row, lines[:first], path)
    body = data.split(b"\n", first)[-1] if first else data
    values, dropped, body = _parse(body, delimiter, columns, style)
    if not len(values):
        raise RoadExtractionError(f"{path} holds no rows of numbers. Check that it is the trajectory and was exported whole.")
    return NumberTable(values, [line for line in lines[:first] if line.strip()], first_row, dropped, body)


def _text_bytes(path):
    try:
        with open(path, "rb") as file:
            data = file.read()
    except OSError as problem:
        raise RoadExtractionError(f"{path} cannot be read ({problem.strerror or problem}). Check the path and the rights to read it.") from problem
    if data[:2] in (b"\xff\xfe", b"\xfe\xff"):
        data = data.decode("utf-16", "replace").encode()
    data = data[3:] if data.startswith(b"\xef\xbb\xbf") else data
    if b"\0" in data[:IO.sample_bytes]:
        raise RoadExtractionError(
            f"{path} is a binary file. A trajectory is read from text (CSV, TXT) or from Applanix SBET (.out, records of 136 bytes).")
    data = _in_utf8(data.replace(b"\r\n", b"\n").replace(b"\r", b"\n").rstrip(b"\x1a\0 \t\n") + b"\n")
    for written, plain in ((b"\xc2\xa0", b" "), (b"\xe2\x80\xaf", b" "), (b"\xe2\x80\x99", b"'"), (b"\xe2\x88\x92", b"-")):
        data = data.replace(written, plain)  # narrow and fixed blanks, the typographic apostrophe and minus
    return data


def _in_utf8(data):
    """The text in UTF-8 where all of its words beyond ASCII are words of East Asia or in Cyrillic in the encoding of these."""
    for encoding, words in () if data.isascii() else (("utf-8", re.compile(".+", re.DOTALL)), *ENCODINGS):
        with suppress(UnicodeDecodeError):
            text = data.decode(encoding)
            if all(map(words.fullmatch, re.findall(r"[a-z]?[^\0-\x7f]+[a-z]?", text))):
                return text.encode()
    return data


def _without_quotes(data):
    """The text with tabs between its columns, where quotes hold commas or other delimiters together."""
    sample = data[:IO.sample_bytes]
    quoted = re.search(rb'(?:^|[,;\t|])"[^"\n]*[,;\t|][^"\n]*"([,;\t|]|$)', sample, re.MULTILINE) if b'"' in sample else None
    if quoted is None:
        return data
    mark = quoted.group(1) or b","
    rows = csv.reader(data.decode("utf-8", "surrogateescape").splitlines(), delimiter=mark.decode())
    return "".join("\t".join(value.replace("\t", " ") for value in row) + "\n" for row in rows).encode("utf-8", "surrogateescape")


def _sample_lines(data):
    whole = data[:IO.sample_bytes].rpartition(b"\n")[0]
    return _decoded(whole).split("\n")


def _fields(line, delimiter):
    """The fields of one line; a delimiter at its end is ignored."""
    line = line.strip().replace('"', "") if delimiter == " " else line.strip(" ").replace('"', "")
    if delimiter == " ":
        return line.split()
    fields = [field.strip() for field in line.split(delimiter)]
    return fields[:-1] if len(fields) > 1 and not fields[-1] else fields


def _is_row(fields, columns, style):
    numbers = _numbers_among(fields, style)
    return len(fields) == columns and numbers >= IO.min_number_columns and 2 * numbers >= len(fields)


def _numbers_among(fields, style):
    return sum(bool(style.number.match(text) or VALUE_PATTERN.match(text)) for text in fields)


def _recognise_format(lines):
    """(delimiter, number of columns, style of numbers) that explain the most lines; None where none does."""
    lines = lines[:IO.sample_lines]
    styles = [style for style in STYLES if not style.grouping or any(map(style.grouped.search, lines))]
    formats = []
    for delimiter in DELIMITERS:
        split = [fields for fields in (_fields(line, delimiter) for line in lines) if len(fields) >= IO.min_number_columns]
        formats += [_explained(split, delimiter, style) for style in styles if delimiter not in (style.decimal, style.grouping)]
    best = max(formats, key=lambda reading: reading[:4])
    return best[4] if best[0] else None


def _explained(split, delimiter, style):
    """(rows, whether they are whole, more numbers than words, whether with a decimal point, format) of lines split at a delimiter."""
    counts = Counter(len(fields) for fields in split if _is_row(fields, len(fields), style))
    columns, rows = next(iter(counts.most_common(1)), (0, 0))
    more_numbers = sum(2 * _numbers_among(fields, style) - columns for fields in split if len(fields) == columns)
    # between tabs that hold nothing but numbers, blanks stand within numbers
    whole = delimiter == "\t" and all(_numbers_among(fields, style) == columns for fields in split if _is_row(fields, columns, style))
    return rows, whole and rows > 0, more_numbers, style.decimal == ".", (delimiter, columns, style)


def _refuse_ambiguous_commas(first_row, above, path):
    """1,5,2,5 may be two numbers or four."""
    whole = all(re.match(r"[+-]?\d+$", field) for field in first_row)
    padded = any(re.match(r"0\d+$", field) for field in first_row)
    header = next((line.split(",") for line in reversed(above) if line.strip()), [])
    if whole and len(first_row) >= 6 and (padded or 2 * len(header) == len(first_row)):
        raise RoadExtractionError(f"{path} uses the comma between columns and as the decimal sign, so its columns cannot be separated. Export it "
                                  "with a decimal point, or with semicolons between the columns.")


def _parse(body, delimiter, columns, style=STYLES[0]):
    """((N, K) values, number of lines with another number of fields, the lines with as many, fields separated by blanks)."""
    body = body.replace(b'"', b"")
    if style.grouping:
        body = re.sub(rb"(?<=\d)" + re.escape(style.grouping.encode()) + rb"(?=\d{3}(?!\d))", b"", body)
    if delimiter != " ":
        body = _fill_empty(body, delimiter.encode())
    comma = ",Dd" if style.decimal == "," else ""
    body = body.translate(bytes.maketrans((delimiter + comma).encode(), (" " + ".ee"[:len(comma)]).encode()))
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
    if not rows:
        return np.empty((0, columns)), dropped, b""
    values = None
    with suppress(ValueError):   # where a field is not a number, fields are parsed one by one
        values = np.loadtxt(io.BytesIO(body), comments=None, ndmin=2, encoding="latin1")
    if values is None or values.shape != (rows, columns):
        values = _parse_mixed(body, columns)
    return finite_or_nan(values).reshape(-1, columns), dropped, body


def finite_or_nan(values: np.ndarray) -> np.ndarray:
    """The values, of any shape, with NaN for those that are infinite or so large that sums overflow."""
    return np.where(np.abs(values) < IO.max_number, values, np.nan)


def as_number(value: Any) -> float:
    """The number in a field, with a decimal point or comma; NaN where it holds none."""
    with suppress(TypeError, ValueError):
        return float(value.replace(",", ".") if isinstance(value, str) else value)
    return np.nan


def _fill_empty(body, mark):
    """Write nan into empty fields, and remove a delimiter at the end of a line."""
    if b" " in body:
        body = re.sub(rb"[ ]*" + re.escape(mark) + rb"[ ]*", mark, body)
        body = re.sub(rb"^[ ]+|[ ]+$", b"", body, flags=re.MULTILINE)
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
    step = IO.fields_per_chunk // columns * columns or columns
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


def _number_or_nan(text):
    with suppress(ValueError):
        return float(text)
    # exponents of Fortran, and units behind numbers
    number = re.fullmatch(rb"([+-]?[\d.]+)(?:[eEdD]([+-]?\d+))?(?:_?([A-Za-z]{1,3}|\xc2?\xb0))?", text)
    unit = _decoded(number[3]).lower() if number and number[3] else ""
    if number is None or (unit and not re.fullmatch(UNIT_SUFFIX, unit)):
        return np.nan
    with suppress(ValueError):
        return float(number[1] + b"e" + (number[2] or b"0"))
    return np.nan


def _decoded(text):
    with suppress(UnicodeDecodeError):
        return text.decode()
    return text.decode("latin-1")
