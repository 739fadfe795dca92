"""What a run of qgis_process says."""

import re


def complaints(stderr):
    """The different lines of an error output: QGIS says each several times.

    What Python says of QGIS's own files is left out (QGIS 3.44 is warned of codecs.open by Python 3.14).
    """
    ours = re.sub(r"^/usr/\S+:\d+: \w*Warning: .*\n(?:  .*\n)?", "", stderr, flags=re.MULTILINE)
    return {line.removeprefix("ERROR:\t").strip() for line in ours.splitlines()} - {""}
