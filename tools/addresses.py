"""Writes the publisher's addresses into the metadata of a release: addresses.py ZIP REPOSITORY EMAIL [HOMEPAGE [TRACKER]]

The checkout names addresses under .example, a domain that nobody can own (RFC 2606): whoever publishes the plugin
answers for it under addresses of their own. QGIS's plugin repository refuses a zip whose addresses cannot be opened.
"""

import re
import sys
import zipfile
from pathlib import Path

METADATA = "lanewright/metadata.txt"


def with_addresses(metadata, repository, email, homepage="", tracker=""):
    """The text of metadata.txt with these addresses; homepage and tracker are the repository's where they are not given."""
    given = {"repository": repository, "email": email, "homepage": homepage or repository, "tracker": tracker or f"{repository.rstrip('/')}/issues"}
    for key, value in given.items():
        pattern = r"\S+@\S+\.\S+" if key == "email" else r"https?://[^/\s]+\.[^/\s]+\S*"
        if not re.fullmatch(pattern, value):
            sys.exit(f"{key} is {value!r}; it must be {'an address such as me@company.org' if key == 'email' else 'a web address: https://…'}.")
        metadata = re.sub(rf"^{key}=.*$", lambda _, line=f"{key}={value}": line, metadata, flags=re.MULTILINE)
    return metadata


def main():
    path = Path(sys.argv[1])
    whole = path.with_suffix(".unaddressed")
    path.replace(whole)
    with zipfile.ZipFile(whole) as source, zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as target:
        for entry in source.infolist():
            content = source.read(entry)
            if entry.filename == METADATA:
                content = with_addresses(content.decode("utf-8"), *sys.argv[2:]).encode("utf-8")
            target.writestr(entry, content)
    whole.unlink()


if __name__ == "__main__":
    main()
