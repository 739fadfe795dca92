"""Tables and numbers in Markdown."""


def table(head, rows, words=1):
    """Markdown; the first `words` columns hold words, the others numbers."""
    lines = [head, ["---"] * words + ["---:"] * (len(head) - words), *rows]
    return "\n".join("| " + " | ".join(str(cell) for cell in line) + " |" for line in lines)


def label(figures):
    """The name of a survey and whether it is simulated or real."""
    return f"{figures['name']} ({figures['kind']})"


def number(value, digits=1):
    return "–" if value is None else f"{value:,.{digits}f}"


def triple(rates):
    """recall / precision / F1"""
    return " / ".join(number(rates[name]) for name in ("recall", "precision", "f1"))


def mean(values):
    known = [value for value in values if value is not None]
    return sum(known) / len(known) if known else None
