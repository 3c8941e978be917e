"""The list of faults: one line of code each, its replacement, and the tests that must fail with it."""

from dataclasses import dataclass
from pathlib import Path

import tomllib

HERE = Path(__file__).parent


@dataclass(frozen=True)
class Fault:
    name: str  # room/fault
    about: str  # the wrong behaviour
    file: str  # from the project's root
    find: str  # one whole line of the file, without its indentation
    put: str
    gtest: str = ""  # a filter of lancer_tests
    pytest: tuple = ()  # from blender_tests, as "abi/test_abi.py::test_versions"

    @property
    def room(self):
        return self.name.split("/")[0]

    @property
    def is_core(self):
        return self.file.startswith("core/")

    def places(self, text):
        """The positions of the line in the file's text, each behind its indentation."""
        found, position = [], 0
        for line in text.splitlines(keepends=True):
            if line.strip() == self.find:
                found.append(position + len(line) - len(line.lstrip()))
            position += len(line)
        return found

    def applied(self, text):
        """The file's text with the fault; ValueError where the line does not stand in it exactly once."""
        places = self.places(text)
        if len(places) != 1:
            raise ValueError(f"{self.name}: {self.file} has this line {len(places)} times: {self.find}")
        return text[: places[0]] + self.put + text[places[0] + len(self.find) :]


def read_faults():
    """All faults, those of the add-on first: they need no compiler. In the core, each file's faults stand together."""
    faults = []
    for path in sorted(HERE.glob("*.toml")):
        for room, named in tomllib.loads(path.read_text(encoding="utf-8")).items():
            for name, fields in named.items():
                fault = Fault(f"{room}/{name}", **{**fields, "pytest": tuple(fields.get("pytest", ()))})
                faults.append(fault)
    return sorted(faults, key=lambda fault: fault.is_core)
