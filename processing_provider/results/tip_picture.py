"""Small pictures in map tips: the step of a curb, the width of a lane between its borders; as expressions of QGIS, from the fields alone."""

from __future__ import annotations

SVG = "<svg xmlns='http://www.w3.org/2000/svg' width='132' height='54'><rect width='132' height='54' fill='white'/>{drawn}</svg>"
TALLEST = 0.30  # m of a curb that reaches the top of the picture

# y of a curb's top; ground is at 44
_TOP = f'round(44 - 34 * min("height_m", {TALLEST}) / {TALLEST})'
_TEXT = "<text x='{x}' y='{y}' font-family='sans-serif' font-size='11' text-anchor='middle'>[{number}] m</text>"


def tip_picture(names: set[str]) -> str:
    """The expression, in [% %], of the picture that a layer's features have in their map tip; "" where its fields give none.

    names : of the fields of the layer
    """
    if {"height_m", "side", "edge"} <= names:
        return _shown(_curb(), '"height_m" IS NOT NULL AND coalesce("edge", \'\') <> \'pavement\'')
    if {"width_m", "left_patt", "right_patt"} <= names:
        return _shown(_lane(), '"width_m" IS NOT NULL')
    return ""


def _curb():
    """Road, face and sidewalk, which lies left of a left edge."""
    road, walk = "[if(\"side\" = 'left', 128, 4)]", "[if(\"side\" = 'left', 4, 128)]"
    foot, head = "[if(\"side\" = 'left', 68, 64)]", "[if(\"side\" = 'left', 64, 68)]"
    line = f"<polyline fill='none' stroke='black' stroke-width='2' points='{road},44 {foot},44 {head},[{_TOP}] {walk},[{_TOP}]'/>"
    number = "format_number(\"height_m\", 2)"
    return line + _TEXT.format(x="[if(\"side\" = 'left', 98, 34)]", y=36, number=number)


def _lane():
    """The two borders, dashed where their paint is, and the width between them."""
    border = ("<line x1='{x}' y1='4' x2='{x}' y2='50' stroke='rgb(33,102,255)' stroke-width='3' "
              "stroke-dasharray='[if(coalesce(\"{field}\", \'\') LIKE \'%dash%\', \'9 6\', \'none\')]'/>")
    across = "<path d='M16,36 H116 M22,32 L16,36 L22,40 M110,32 L116,36 L110,40' fill='none' stroke='black'/>"
    number = "format_number(\"width_m\", 2)"
    return border.format(x=10, field="left_patt") + border.format(x=122, field="right_patt") + across + _TEXT.format(x=66, y=26, number=number)


def _shown(drawn, condition):
    """The expression that gives the picture: what stands in brackets is put in as its value."""
    pieces = []
    for number, part in enumerate(SVG.format(drawn=drawn).replace("]", "[").split("[")):
        pieces.append(part if number % 2 else "'" + part.replace("'", "''") + "'")
    picture = " || ".join(f"({piece})" if number % 2 else piece for number, piece in enumerate(pieces))
    return f"[% CASE WHEN {condition} THEN '<br><img src=\"data:image/svg+xml;utf8,' || {picture} || '\"/>' ELSE '' END %]"
