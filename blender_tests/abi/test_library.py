"""The library's file (missing, broken, foreign, outdated), its header and its symbols."""

import os
import re
import shutil
import subprocess
import sys

import pytest
from conftest import ROOT

from addon.bindings import abi

HEADER = os.path.join(ROOT, "core", "include", "lancer.h")
PROBES = os.path.join(ROOT, "core", "include", "lancer_probes.h")


def refusal(path):
    """Return the message with which load_library refuses path."""
    with pytest.raises(abi.LancerError) as error:
        abi.load_library(path)
    text = str(error.value)
    assert "\n" not in text and str(path) in text
    return text


def test_absent(tmp_path):
    assert "missing" in refusal(tmp_path / "liblancer.so")


@pytest.mark.parametrize("size", [0, 10, 1000, 0.5, 0.99, -1])
def test_truncated(tmp_path, library, size):
    """A truncated library would die of SIGBUS when touched: it must be refused before it is mapped. -1: of the last byte."""
    whole = open(abi.library_path(), "rb").read()
    path = tmp_path / "liblancer.so"
    path.write_bytes(whole[: size if isinstance(size, int) else int(len(whole) * size)])
    assert "cut short" in refusal(path)


def test_not_a_library(tmp_path):
    path = tmp_path / "liblancer.so"
    path.write_bytes(b"This is no library at all." * 1000)
    assert "not a shared library" in refusal(path)


def test_another_processor(tmp_path, library):
    data = bytearray(open(abi.library_path(), "rb").read())
    data[18:20] = (183 if data[18] != 183 else 62).to_bytes(2, "little")
    path = tmp_path / "liblancer.so"
    path.write_bytes(data)
    # The path has the word, too: the sentence is that of the look into the file.
    assert "another kind of processor" in refusal(path)


def compiled(tmp_path, source, name):
    compiler = shutil.which("gcc") or shutil.which("cc")
    assert compiler, "a C compiler is needed"
    (tmp_path / "stub.c").write_text(source)
    path = tmp_path / name
    subprocess.run([compiler, "-shared", "-fPIC", "-o", path, tmp_path / "stub.c"], check=True)
    return path


QUERIES = """
const char *lancer_version(void) {{ return "9.9.9"; }}
const char *lancer_last_error(void) {{ return ""; }}
unsigned lancer_abi_version(void) {{ return {version}; }}
unsigned lancer_sizeof(unsigned which) {{ return {size}; }}
"""


def test_other_interface_version(tmp_path):
    path = compiled(tmp_path, QUERIES.format(version=abi.ABI_VERSION + 1, size=0), "other.so")
    text = refusal(path)
    assert str(abi.ABI_VERSION + 1) in text and str(abi.ABI_VERSION) in text


def test_other_struct_sizes(tmp_path):
    text = refusal(compiled(tmp_path, QUERIES.format(version=abi.ABI_VERSION, size=4), "sizes.so"))
    assert "version" in text and " 4 bytes" in text


def test_some_other_library(tmp_path):
    assert "version" in refusal(compiled(tmp_path, "int nothing(void) { return 0; }", "foreign.so"))


def test_versions_and_sizes(library):
    assert library.lancer_abi_version() == abi.ABI_VERSION
    assert re.fullmatch(r"\d+\.\d+\.\d+", library.lancer_version().decode())
    for number, structure in abi.STRUCTS.items():
        assert library.lancer_sizeof(number) == abi.ctypes.sizeof(structure), structure
    assert library.lancer_sizeof(len(abi.STRUCTS)) == 0 and library.lancer_sizeof(2**32 - 1) == 0


def test_header_is_c99(tmp_path):
    """The header compiles alone as strict C99 and as C++ without warnings."""
    (tmp_path / "use.c").write_text(
        '#include "lancer_probes.h"\nint main(void) { return lancer_abi_version() == LANCER_ABI_VERSION; }\n'
    )
    include = os.path.dirname(HEADER)
    for language in (["-std=c99", "-x", "c"], ["-std=c++20", "-x", "c++"]):
        command = [
            "g++" if "c++" in language else "gcc",
            *language,
            "-Wall",
            "-Wextra",
            "-Wpedantic",
            "-Werror",
            "-I",
            include,
            "-fsyntax-only",
            tmp_path / "use.c",
        ]
        done = subprocess.run(command, capture_output=True, text=True)
        assert done.returncode == 0, done.stderr


def test_bindings_are_those_that_the_header_gives_now(tmp_path):
    """After a change of the header, `make bindings` must be run for the Python bindings and the core's table."""
    subprocess.run([sys.executable, os.path.join(ROOT, ".ci", "bindings.py"), tmp_path], check=True)
    # Python's enums.py and the core's enums.h are two files.
    core = "core/src/scene/enums.h", "core/src/integrator/settings_table.h"
    for made in ("addon/bindings/enums.py", "addon/bindings/structs.py", *core):
        with open(os.path.join(ROOT, made), encoding="utf-8") as file:
            assert file.read() == (tmp_path / os.path.basename(made)).read_text(encoding="utf-8"), made


def test_bindings_name_every_function_of_the_header():
    text = "".join(open(header, encoding="utf-8").read() for header in (HEADER, PROBES))
    functions = set(re.findall(r"^LANCER_API [^;]*?\b(lancer_\w+)\(", text, re.M))
    assert functions == set(abi._CALLS) | set(abi._QUERIES)


def assert_that_c_holds(tmp_path, facts):
    checks = "".join(f'_Static_assert({fact}, "{fact}");\n' for fact in facts)
    (tmp_path / "facts.c").write_text('#include "lancer_probes.h"\n' + checks)
    command = ["gcc", "-std=c11", "-I", os.path.dirname(HEADER), "-fsyntax-only", tmp_path / "facts.c"]
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr


def test_numbers_are_those_that_the_compiler_reads(tmp_path):
    enums = {
        "LANCER_PASS_": abi.Pass,
        "LANCER_FALLOFF_": abi.Falloff,
        "LANCER_SHADING_": abi.Shading,
        "LANCER_STRUCT_": abi.Struct,
        "LANCER_FEATURES_": abi.Features,
        "LANCER_FILTER_": abi.PixelFilter,
        "LANCER_NORMALS_": abi.NormalDomain,
        "LANCER_RULES_": abi.Rules,
        "LANCER_MATERIAL_": abi.MaterialFlag,
        "LANCER_INSTANCE_": abi.InstanceFlag,
    }
    plain = [
        abi.Status,
        abi.InstanceKind,
        abi.LobeKind,
        abi.LightKind,
        abi.AreaShape,
        abi.Accelerator,
        abi.CameraKind,
        abi.Integrator,
    ]
    names = [(p + m.name, int(m)) for p, e in enums.items() for m in e]
    names += [("LANCER_" + m.name, int(m)) for e in plain for m in e]
    assert_that_c_holds(tmp_path, [f"{name} == {value}" for name, value in names])


def test_structs_lie_as_the_compiler_lays_them(tmp_path):
    facts = []
    for number, structure in abi.STRUCTS.items():
        name = f"lancer_{number.name.lower()}"
        facts.append(f"sizeof({name}) == {abi.ctypes.sizeof(structure)}")
        for field, *_ in structure._fields_:
            place = getattr(structure, field)
            facts.append(f"offsetof({name}, {field}) == {place.offset}")
            facts.append(f"sizeof((({name} *)0)->{field}) == {place.size}")
    assert_that_c_holds(tmp_path, facts)


def test_exported_symbols(library):
    """The library exports only lancer_*, since Blender's process contains many other libraries."""
    done = subprocess.run(["nm", "-D", "--defined-only", abi.library_path()], capture_output=True, text=True, check=True)
    names = {line.split()[-1].split("@")[0] for line in done.stdout.splitlines()}
    assert names == set(abi._CALLS) | set(abi._QUERIES)


def test_needs_nothing_but_the_c_library(library):
    done = subprocess.run(["readelf", "-d", abi.library_path()], capture_output=True, text=True, check=True)
    needed = set(re.findall(r"\(NEEDED\).*\[(.*?)\]", done.stdout))
    assert {name.split(".so")[0] for name in needed} <= {
        "libc",
        "libm",
        "libpthread",
        "libdl",
        "ld-linux-x86-64",
        "ld-linux-aarch64",
    }
