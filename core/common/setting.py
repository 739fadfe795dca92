"""A setting with its limits: one pair of numbers for what the core refuses and what a dialog offers."""

from dataclasses import dataclass, field, fields

from .errors import RoadExtractionError

_KEY = "limits"


@dataclass(frozen=True)
class Limits:
    """What a setting may be.

    minimum, maximum : both allowed, in `unit`
    name : the setting as a sentence begins with it
    zero : what 0 stands for, where 0 is allowed though it lies below the minimum; "" where it is not
    """

    minimum: float
    maximum: float
    name: str
    unit: str = ""
    zero: str = ""

    @property
    def lowest(self):
        """The least number that is allowed, the 0 that stands for something else among them."""
        return 0 * self.minimum if self.zero else self.minimum

    def check(self, value):
        """Refuse a value that is not allowed.

        Raises
        ------
        RoadExtractionError
            If it lies outside the limits, or is no number.
        """
        if self.minimum <= value <= self.maximum or self.zero and value == 0:
            return
        unit = self.unit if self.unit in ("", "°") else f" {self.unit}"
        zero = f", or 0 {self.zero}" if self.zero else ""
        raise RoadExtractionError(f"{self.name} is {value}{unit}; it must be between {self.minimum:.10g} and {self.maximum:.10g}{unit}{zero}.")


def setting(default, minimum, maximum, name, unit="", zero=""):
    """A number of a Settings class with its Limits; `check_limits` in `__post_init__` refuses what lies outside."""
    return field(default=default, metadata={_KEY: Limits(minimum, maximum, name, unit, zero)})


def limits_of(settings, name):
    """The Limits of a field of a Settings class or object, None where it has none."""
    return next(entry.metadata.get(_KEY) for entry in fields(settings) if entry.name == name)


def check_limits(settings):
    """Refuse the first of the settings that lies outside its limits.

    Raises
    ------
    RoadExtractionError
        If there is one.
    """
    for entry in fields(settings):
        if _KEY in entry.metadata:
            entry.metadata[_KEY].check(getattr(settings, entry.name))
