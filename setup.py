"""The library as a package: the checkout is itself the package `lanewright`, of which what needs QGIS is left out."""

import shutil
from pathlib import Path

from setuptools import find_packages, setup
from setuptools.command.build_py import build_py

FOLDERS = ("core", "products", "simulator", "algorithms", "library")


class BuildWithoutPlugin(build_py):
    def run(self):
        """Begin anew: an earlier build may have left modules that have gone since."""
        if not getattr(self, "editable_mode", False):
            shutil.rmtree(self.build_lib, ignore_errors=True)
        super().run()

    def find_package_modules(self, package, package_dir):
        """Of the checkout's own files `__init__.py` alone: the others are for QGIS or for the build."""
        return [module for module in super().find_package_modules(package, package_dir) if package != "lanewright" or module[1] == "__init__"]


def version():
    """The one version there is."""
    lines = (Path(__file__).parent / "metadata.txt").read_text(encoding="utf-8").splitlines()
    return next(line.partition("=")[2].strip() for line in lines if line.startswith("version="))


setup(
    version=version(),
    package_dir={"lanewright": "."},
    packages=["lanewright"] + [f"lanewright.{name}" for name in find_packages(".", include=[pattern for name in FOLDERS
                                                                                         for pattern in (name, f"{name}.*")])],
    package_data={"lanewright.products.report": ["templates/*.html"], "lanewright.core.survey.trajectory": ["column_names.txt"],
                  "lanewright.core.common": ["words.txt"], "lanewright.core.countries": ["countries.json", "traffic_sides.txt"],
                  "lanewright.algorithms": ["help.txt"], "lanewright.products.export": ["templates/*"],
                  "lanewright.products.export.check": ["faults.txt", "words.txt"], "lanewright.products.overlay": ["column_names.txt"],
                  "lanewright": ["resources/i18n/*.json", "resources/templates/*.csv"]},
    # build/ is that of the checkout
    options={"build": {"build_base": "build/package"}},
    cmdclass={"build_py": BuildWithoutPlugin},
)
