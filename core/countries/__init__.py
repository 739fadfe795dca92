"""What road authorities prescribe, country by country.

In: the name of a country. Out: a `Country` with lane widths, line widths, dash patterns and a design code, each with its source. By place on earth
the catalogue says on which side traffic drives, and nothing else.
"""
