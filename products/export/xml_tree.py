"""XML read with limits, so that a hostile file is refused before it costs memory, and written."""

from __future__ import annotations

import codecs
import io
import math
import re
from collections.abc import Iterator, Mapping, Sequence
from functools import lru_cache
from html import escape
from pathlib import Path
from pyexpat import ExpatError, ParserCreate
from typing import Any

from ...core.common.errors import RoadExtractionError
from ...core.common.progress import Progress

CHUNK = 1 << 16             # bytes handed to the parser at once
MAX_UNTAGGED = 4 << 20      # bytes without the end of a tag: longer tags, texts and blanks hide no map
MAX_ELEMENTS = 1_000_000    # some hundred kilometres of lanes
MAX_DEPTH = 60
MAX_MAP_NUMBER = 1e9            # metres or any other unit of a map
MAX_DIGITS = 400            # characters of a number
HEAD = 400                  # bytes in which the declaration of the encoding is looked for
BYTE_ORDER_MARKS = {codecs.BOM_UTF32_LE: "utf-32", codecs.BOM_UTF32_BE: "utf-32", codecs.BOM_UTF8: "utf-8-sig", codecs.BOM_UTF16_LE: "utf-16",
                    codecs.BOM_UTF16_BE: "utf-16"}   # those of 32 bits first: they begin like those of 16


class XmlElement:
    """One element of an XML file.

    tag : name; attributes : of str; children : list of XmlElement; text : without blanks around it; line : in the file
    """

    __slots__ = ("attributes", "children", "line", "tag", "text")

    def __init__(self, tag: str, attributes: Mapping[str, str] | None = None, line: int = 0) -> None:
        self.tag, self.text, self.line = tag, "", line
        self.attributes: Mapping[str, str] = attributes or {}
        self.children: Sequence[XmlElement] = ()   # most have none: a list is made for the first

    def append(self, child: XmlElement) -> None:
        if isinstance(self.children, list):
            self.children.append(child)
        else:
            self.children = [child]

    def all(self, *path: str) -> Iterator[XmlElement]:
        """The children of a name; of several names, those of the last one in the first child of the others."""
        parent, tag = self.find(*path[:-1]), path[-1]
        return (child for child in (parent.children if parent is not None else ()) if child.tag == tag)

    def find(self, *path: str) -> XmlElement | None:
        """The first child of a name, its first child of the next name and so on; None where there is none."""
        element: XmlElement | None = self
        for tag in path:
            element = next(element.all(tag), None) if element is not None else None
        return element

    def get(self, name: str, missing: str = "") -> str:
        return self.attributes.get(name, missing)

    def number(self, name: str, missing: float | None = None) -> float:
        """A finite number of an attribute. Raises RoadExtractionError if it is missing and has no default, or is no number of a map."""
        text = self.attributes.get(name)
        if text is None:
            if missing is None:
                raise RoadExtractionError(f"Line {self.line}: <{self.tag}> has no {name}. Is the file whole and of the right format?")
            return missing
        try:
            value = float(text) if len(text) <= MAX_DIGITS else math.inf
        except ValueError:
            value = math.nan
        if not abs(value) <= MAX_MAP_NUMBER:
            raise RoadExtractionError(f"Line {self.line}: {name} of <{self.tag}> is {text[:40]!r}; a number up to {MAX_MAP_NUMBER:g} is needed.")
        return value


def written(value: Any) -> str:
    """A value as XML has it: numbers with all their digits and no more."""
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, float) or hasattr(value, "dtype"):
        number = float(value)
        return repr(int(number)) if number == int(number) and abs(number) < 1e15 else repr(number)
    return str(value)


def file_text(template: str, **values: Any) -> str:
    """A whole file as text, by a template and what it is filled with, which in XML is written as that has it."""
    return str(_templates().get_template(template).render(values))


@lru_cache(maxsize=1)
def _templates():
    """The jinja2.Environment of the files; `attributes` of an element of XML are left out where they are None."""
    from jinja2 import Environment, FileSystemLoader, StrictUndefined, pass_eval_context  # only when a file is written: QGIS starts no slower
    from markupsafe import Markup

    def escaped(value, quote=True):
        return value if isinstance(value, Markup) else Markup(escape(written(value), quote))   # nosec B704: it is escaped

    @pass_eval_context
    def put_in(context, value):
        return escaped(value) if context.autoescape else value

    environment = Environment(  # nosec B701: XML is escaped
        loader=FileSystemLoader(str(Path(__file__).parent / "templates")), autoescape=lambda name: name.endswith(".xml"), undefined=StrictUndefined,
        trim_blocks=True, lstrip_blocks=True, keep_trailing_newline=True, finalize=put_in)
    environment.filters["text"] = lambda value: escaped(value, quote=False)
    environment.globals.update(zip=zip, attributes=lambda **values: Markup("").join(
        Markup(' {}="{}"').format(name, escaped(value)) for name, value in values.items() if value is not None))
    return environment


def read_xml(path: str, root_tag: str, kind: str, progress: Progress = Progress()) -> XmlElement:
    """Read a file whole, within limits.

    path : of the file
    root_tag : name that its first element must have
    kind : what the file should be, for messages
    Returns XmlElement, the root
    Raises RoadExtractionError if it is no XML, not of this kind, in an encoding that is not known or that it is not written in, declares a document
    type or entities (no map needs them), or is larger, deeper or emptier than a map is.
    """
    return _Reading(Path(path), root_tag, kind).run(progress)


class _Reading:
    """One file on its way through the parser."""

    def __init__(self, path, root_tag, kind):
        self.path, self.root_tag, self.kind = path, root_tag, kind
        self.root, self.open, self.count, self.last_tag = None, [], 0, 0
        self.encoding, self.is_named = self._encoding()
        self.parser = parser = ParserCreate("utf-8")   # what it is fed
        parser.StartElementHandler, parser.EndElementHandler = self._start, self._end
        parser.CharacterDataHandler, parser.buffer_text = self._text, True   # not line by line
        parser.StartDoctypeDeclHandler = parser.EntityDeclHandler = self._declared
        parser.UnparsedEntityDeclHandler = parser.ExternalEntityRefHandler = self._declared

    def run(self, progress):
        size, fed = max(self.path.stat().st_size, 1), 0
        try:
            with open(self.path, encoding=self.encoding, newline="") as file:
                while chunk := file.read(CHUNK).encode("utf-8"):
                    self.parser.Parse(chunk, False)
                    fed += len(chunk)
                    if fed - self.last_tag > MAX_UNTAGGED:
                        self._refuse(f"has {MAX_UNTAGGED >> 20} MB without the end of a tag")
                    progress.report(file.buffer.tell() / size)
                self.parser.Parse(b"", True)
        except UnicodeError as problem:
            raise RoadExtractionError(
                f"{self.path} is not written in the encoding {self.encoding} that it declares. Save it again as UTF-8, and say so in its first line."
                if self.is_named else f"{self.path} is not written in UTF-8, though it names no other encoding. Save it again as UTF-8, or name its "
                "encoding in its first line.") from problem
        except ExpatError as problem:
            raise RoadExtractionError(f"{self.path} is not well-formed XML: {problem}. Is it {self.kind}, and whole?") from problem
        return self.root

    def _encoding(self):
        """(the encoding of the file, whether it is another than UTF-8 that the file names)."""
        with open(self.path, "rb") as file:
            head = file.read(HEAD)
        marked = next((name for mark, name in BYTE_ORDER_MARKS.items() if head.startswith(mark)), "")
        if marked or head[:4] in ("<".encode("utf-32-le"), "<".encode("utf-32-be")):
            return marked or ("utf-32-le" if head[:1] == b"<" else "utf-32-be"), True
        declared = re.match(rb"""\s*<\?xml[^>]*?\sencoding\s*=\s*["']([^"'>]*)["']""", head)
        name = (declared[1] if declared else b"").decode("latin-1") or "utf-8"
        try:
            io.TextIOWrapper(io.BytesIO(), name)   # others than those of text, such as zip and hex, are refused
            codec = codecs.lookup(name).name
        except (LookupError, ValueError):
            raise RoadExtractionError(f"{self.path} declares the encoding {name[:40]!r}, which is not known. Save it again as UTF-8, and say so in "
                                      "its first line.") from None
        # the declaration itself is written in single bytes: some programs state what they have in memory
        codec = "utf-8" if codec.startswith(("utf-16", "utf-32")) else codec
        return codec, codec != "utf-8"

    def _refuse(self, why):
        raise RoadExtractionError(f"{self.path} {why}. That is not {self.kind}, so it was not read further. Export the map again, or in parts.")

    def _declared(self, *_):
        self._refuse("declares a document type or entities, which no map needs")

    def _start(self, tag, attributes):
        if self.root is None and tag != self.root_tag:
            raise RoadExtractionError(f"{self.path} begins with <{tag[:40]}>; {self.kind} begins with <{self.root_tag}>. Choose another file.")
        if self.root is not None and not self.open:
            self._refuse("has more than one first element")
        self.count += 1
        if len(self.open) >= MAX_DEPTH:
            self._refuse(f"has elements within elements, more than {MAX_DEPTH} deep")
        if self.count > MAX_ELEMENTS:
            self._refuse(f"has more than {MAX_ELEMENTS:,} elements")
        element = XmlElement(tag, attributes, self.parser.CurrentLineNumber)
        self.last_tag = self.parser.CurrentByteIndex
        if self.open:
            self.open[-1].append(element)
        else:
            self.root = element
        self.open.append(element)

    def _end(self, _):
        element = self.open.pop()
        element.text = element.text.strip()
        self.last_tag = self.parser.CurrentByteIndex

    def _text(self, text):
        element = self.open[-1]
        if element.text or text.strip():
            element.text += text
