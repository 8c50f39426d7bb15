"""The licences of all installed packages that Meshwright depends on."""

import re
from dataclasses import dataclass
from importlib.metadata import Distribution, PackageNotFoundError, distribution

from packaging.requirements import Requirement

NAME = "meshwright"
UNKNOWN = "not stated"
_LONGEST = 60
"""A licence field longer than this is the licence's text, not its name."""
_FILES = re.compile(r"(^|/)(licen[cs]e|copying|notice)[^/]*$", re.IGNORECASE)
_CLASSIFIER = "License :: "


@dataclass(frozen=True)
class Licence:
    """A package, its version, the name of its licence, and where that can be read."""

    package: str
    version: str
    licence: str
    url: str

    def text(self) -> str:
        """The texts of its licence as they were installed; empty if there are none."""
        return licence_text(self.package)


def licences() -> list[Licence]:
    """The packages that Meshwright depends on, directly or indirectly, sorted by name."""
    seen: dict[str, Licence] = {}
    waiting = [NAME]
    while waiting:
        name = waiting.pop()
        key = _key(name)
        found = _distribution(name)
        if key in seen or found is None:
            continue  # not needed on this machine
        seen[key] = Licence(
            found.metadata["Name"] or name, found.version, licence_name(found), _url(found)
        )
        for requirement in found.requires or []:
            needed = Requirement(requirement)
            if needed.marker is None or needed.marker.evaluate({"extra": ""}):
                waiting.append(needed.name)
    seen.pop(_key(NAME), None)
    return sorted(seen.values(), key=lambda one: one.package.lower())


def licence_name(found: Distribution) -> str:
    """The name of a package's licence in its metadata."""
    metadata = found.metadata
    expression = metadata["License-Expression"]
    if expression:
        return str(expression)
    stated = " ".join(str(metadata["License"] or "").split())
    if stated and len(stated) <= _LONGEST and stated.upper() != "UNKNOWN":
        return stated
    classes = [one for one in metadata.get_all("Classifier") or [] if one.startswith(_CLASSIFIER)]
    names = [one.rpartition(" :: ")[2] for one in classes]
    return ", ".join(dict.fromkeys(names)) or UNKNOWN


def licence_text(package: str) -> str:
    """The texts of a package's licence, as installed; empty if there are none."""
    found = _distribution(package)
    texts = []
    for path in (found.files or []) if found is not None else []:
        if _FILES.search(str(path)) and path.suffix.lower() in ("", ".txt", ".md", ".rst"):
            try:
                texts.append(path.read_text(encoding="utf-8"))
            except (OSError, UnicodeDecodeError):
                continue  # listed but missing, or not text; the name is shown anyway
    return "\n\n".join(dict.fromkeys(text.strip() for text in texts if text.strip()))


def _distribution(name: str) -> Distribution | None:
    try:
        return distribution(name)
    except PackageNotFoundError:
        return None


def _key(name: str) -> str:
    return re.sub(r"[-_.]+", "-", name).lower()


def _url(found: Distribution) -> str:
    """The address of a package's home page; empty if none is stated."""
    home = found.metadata["Home-page"]
    if home and str(home).startswith("http"):
        return str(home)
    for line in found.metadata.get_all("Project-URL") or []:
        word, _, address = str(line).partition(",")
        if word.strip().lower() in ("homepage", "repository", "source", "source code", "home"):
            return address.strip()
    return ""
