"""Every algorithm, in the order of the work."""

from . import assess, driving, export, inventory, markings, overlay, road, survey
from .algorithm import GROUPS, Algorithm

MODULES = (survey, road, markings, driving, export, inventory, assess, overlay)
ALGORITHMS = tuple(value for module in MODULES for value in vars(module).values()
                   if isinstance(value, type) and issubclass(value, Algorithm) and value.__module__ == module.__name__)


def toolbox_number(ID):
    """"2.3" for the third algorithm of the second group, "6.03" where a group has ten or more: the toolbox sorts by name."""
    declared = next(algorithm for algorithm in ALGORITHMS if algorithm.ID == ID)
    group = [algorithm.ID for algorithm in ALGORITHMS if algorithm.GROUP == declared.GROUP]
    return f"{GROUPS.index(declared.GROUP) + 1}.{group.index(ID) + 1:0{len(str(len(group)))}}"
