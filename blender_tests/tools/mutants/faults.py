"""The list of faults: one line of code each, its replacement, and the tests that must fail with it."""

import re
import zlib
from dataclasses import dataclass
from pathlib import Path

import tomllib

HERE = Path(__file__).parent
# A condition; a value that is declared or assigned; a function on one line; else a whole statement.
_CONDITION = re.compile(r"((?:\} )?(?:else )?(?:if|while) )\((.*)\)( \{)?")
_VALUE = re.compile(r"(?!return\b)(?:constexpr )?([\w:<>,*&. \[\]-]+ )= (.+);")
_FUNCTION = re.compile(r"(.*\)(?: const)? \{) (.*;) \}")


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

    @property
    def number(self):
        """Tells a fault of the core from the others that are compiled beside it."""
        return zlib.crc32(self.name.encode())

    def places(self, text):
        """The positions of the line in the file's text, each behind its indentation."""
        found, position = [], 0
        for line in text.splitlines(keepends=True):
            if line.strip() == self.find:
                found.append(position + len(line) - len(line.lstrip()))
            position += len(line)
        return found

    def applied(self, text, line=None):
        """The file's text with the fault, or with another line; ValueError where its line does not stand in it exactly once."""
        places = self.places(text)
        if len(places) != 1:
            raise ValueError(f"{self.name}: {self.file} has this line {len(places)} times: {self.find}")
        return text[: places[0]] + (self.put if line is None else line) + text[places[0] + len(self.find) :]

    def switched(self):
        """The line of C++ that is the wrong one where lancer_fault is this fault's number."""
        asked = f"lancer_fault == {self.number:#010x}u"
        right, wrong = (_CONDITION.fullmatch(line) for line in (self.find, self.put))
        if right and wrong and right.group(1, 3) == wrong.group(1, 3):
            return f"{right[1]}({asked} ? ({wrong[2]}) : ({right[2]})){right[3] or ''}"
        right, wrong = (_VALUE.fullmatch(line) for line in (self.find, self.put))
        if right and wrong and right[1] == wrong[1]:
            return f"{right[1]}= {asked} ? ({wrong[2]}) : ({right[2]});"
        right, wrong = (_FUNCTION.fullmatch(line) for line in (self.find, self.put))
        if right and wrong and right[1] == wrong[1]:
            return f"{right[1]} if ({asked}) {{ {wrong[2]} }} else {{ {right[2]} }} }}"
        if all(line.endswith(";") and line.count("(") == line.count(")") for line in (self.find, self.put)):
            return f"{{ if ({asked}) {{ {self.put} }} else {{ {self.find} }} }}"
        raise ValueError(f"{self.name}: neither a condition, nor a value, nor a statement: {self.find}")


def read_faults():
    """All faults, those of the add-on first: they need no compiler."""
    faults = []
    for path in sorted(HERE.glob("*.toml")):
        for room, named in tomllib.loads(path.read_text(encoding="utf-8")).items():
            for name, fields in named.items():
                faults.append(Fault(f"{room}/{name}", **{**fields, "pytest": tuple(fields.get("pytest", ()))}))
    return sorted(faults, key=lambda fault: fault.is_core)


# The number of the fault that is on, 0 for none; before any other variable is initialised.
SWITCH = """#include <cstdlib>
extern "C" unsigned lancer_fault;
unsigned lancer_fault = 0;
__attribute__((constructor(101))) static void choose() {
  if (const char *number = std::getenv("LANCER_FAULT"))
    lancer_fault = unsigned(std::strtoul(number, nullptr, 10));
}
"""


def switched_files(faults, read):
    """{file: its text with all faults of the core, each behind its switch}; read(file) returns the text without them."""
    texts = {"core/src/fault_switch.cpp": SWITCH}
    for fault in faults:
        text = texts.get(fault.file) or 'extern "C" unsigned lancer_fault;\n' + read(fault.file)
        texts[fault.file] = fault.applied(text, fault.switched())
    return texts
