"""What the figures were taken on."""

import os
import platform
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

import numpy as np


def machine(cores):
    """Processor, cores used, memory, system and the versions that matter, as a dict."""
    told = Path("/proc/cpuinfo").read_text() if Path("/proc/cpuinfo").exists() else ""
    models = [line.split(":", 1)[1].strip() for line in told.splitlines() if line.startswith("model name")]
    memory = os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES") / 2**30
    return dict(processor=models[0] if models else platform.machine(), cores=cores, of=os.cpu_count(), memory_gib=memory,
                system=platform.freedesktop_os_release().get("PRETTY_NAME", platform.system()),
                python=platform.python_version(), numpy=np.__version__,
                **{name: _version(name) for name in ("laspy", "lazrs", "scipy")})


def _version(name):
    try:
        return version(name)
    except PackageNotFoundError:
        return "?"
