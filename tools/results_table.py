"""Results as one table: a row for each figure, in a CSV file beside the page that quotes some of them."""

import csv

COLUMNS = ("table", "of", "case", "figure", "value")


class Results:
    """Values by (table, of, case, figure): the table they belong to, the survey or row, how it was measured, and what the value is."""

    def __init__(self):
        self.values = {}

    @classmethod
    def read(cls, path):
        """The table in a CSV file; numbers are floats, words are text."""
        table = cls()
        with open(path, newline="", encoding="utf-8") as file:
            for *key, value in list(csv.reader(file))[1:]:
                table.values[tuple(key)] = _number(value)
        return table

    def write(self, path):
        """Write the CSV file; numbers with three decimals at most."""
        with open(path, "w", newline="", encoding="utf-8") as file:
            writer = csv.writer(file, lineterminator="\n")
            writer.writerow(COLUMNS)
            writer.writerows([*key, f"{value:.3f}".rstrip("0").rstrip(".") if isinstance(value, float) else value]
                             for key, value in self.values.items())

    def put(self, table, of, case, figures):
        """Add {figure: value}; what is None was not measured and is left out."""
        self.values.update({(table, of, case, figure): value for figure, value in figures.items() if value is not None})

    def get(self, table, of, case, figure):
        """A value, None where there is none."""
        return self.values.get((table, of, case, figure))

    def names(self, table, column="of"):
        """The values of a column (of, case or figure) in a table, each once, in their order."""
        return list(dict.fromkeys(key[COLUMNS.index(column)] for key in self.values if key[0] == table))


def _number(text):
    try:
        return float(text)
    except ValueError:
        return text


def markdown(head, rows, words=1):
    """A table in Markdown; the first `words` columns hold words, the others numbers."""
    lines = [head, ["---"] * words + ["---:"] * (len(head) - words), *rows]
    return "\n".join("| " + " | ".join(str(cell) for cell in line) + " |" for line in lines)


def number(value, digits=1):
    """A number for people, a dash where there is none."""
    return "–" if value is None else f"{value:,.{digits}f}"
