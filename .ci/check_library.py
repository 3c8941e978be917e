"""check_library.py PLATFORM FILE: checks that a library needs no more than the oldest supported system offers.

Checks what is known without running the library: processor, exported names, required libraries and versions of symbols, oldest
system; by llvm-readobj and llvm-objdump, which read all three file formats."""

import re
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
OLDEST_GLIBC = (2, 28)
OLDEST_MACOS = (11, 0)
# Libraries that each platform may load: the C library of its system only. The last ones are part of Windows 10 and newer.
LIBRARIES = {
    "linux": r"lib(c|m|dl|pthread|rt)\.so\.\d+|ld-linux-(x86-64|aarch64)\.so\.\d+",
    "windows": r"KERNEL32\.dll|api-ms-win-crt-[a-z]+-l1-1-0\.dll",
    "macos": r"/usr/lib/libSystem\.B\.dylib",
}
# Symbols that zig's linker exports in addition: marks of the file, and new and delete, for which macOS uses the system's
# definition in the whole process, as in every C++ program.
SHOWN_ANYWAY = {"macos": r"_Zn[aw]\w+|_Zd[al]\w+|__dso_handle|_mh_dylib_header"}


def said(*command):
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode:
        sys.exit(f"{' '.join(map(str, command))} failed:\n{done.stderr}")
    return done.stdout


def declared():
    """Returns the names of the C interface."""
    text = "".join((ROOT / "core/include" / name).read_text() for name in ("lancer.h", "lancer_probes.h"))
    return set(re.findall(r"^LANCER_API [^;(]*?\b(lancer_\w+)\(", text, re.MULTILINE))


def version(text):
    return tuple(map(int, text.split(".")))


def check_elf(path):
    symbols = re.findall(r"Symbol \{(.*?)\n  \}", said("llvm-readobj", "--dyn-symbols", path), re.DOTALL)
    exported = {re.search(r"Name: ([^\s@]+)", one)[1] for one in symbols if "Section: Undefined" not in one}
    needed = re.search(r"NeededLibraries \[(.*?)\]", said("llvm-readobj", "--needed-libs", path), re.DOTALL)[1].split()
    wanted = re.findall(r"Name: GLIBC_([\d.]+)", said("llvm-readobj", "--version-info", path))
    newest = max(map(version, wanted))
    return exported, needed, {f"glibc {'.'.join(map(str, newest))}": newest <= OLDEST_GLIBC}


def check_pe(path):
    text = said("llvm-readobj", "--file-headers", "--coff-exports", "--coff-imports", path)
    exported = set(re.findall(r"Export \{.*?Name: (\S+)", text, re.DOTALL))
    needed = re.findall(r"Import \{\s+Name: (\S+)", text)
    randomised = {"_DYNAMIC_BASE", "_HIGH_ENTROPY_VA", "_NX_COMPAT"}
    return exported, needed, {"may lie anywhere, runs no data": all(name in text for name in randomised)}


def check_macho(path):
    commands = said("llvm-objdump", "--macho", "--private-headers", path)
    needed = re.findall(r"cmd LC_(?:LOAD|LOAD_WEAK|REEXPORT)_DYLIB\b.*?name (\S+)", commands, re.DOTALL)
    least = re.search(r"cmd LC_BUILD_VERSION.*?minos ([\d.]+)", commands, re.DOTALL)[1]
    facts = {f"macOS {least}": version(least) <= OLDEST_MACOS}
    # Apple's own processors run only signed code; an ad-hoc signature suffices.
    if "ARM64" in commands:
        facts["signed"] = "LC_CODE_SIGNATURE" in commands
    symbols = said("llvm-objdump", "--macho", "--exports-trie", path)
    return {name[1:] for name in re.findall(r"\s(_\w+)\s*(?:\[|$)", symbols, re.MULTILINE)}, needed, facts


def main(platform, path):
    system, processor = platform.split("-")
    check = {"linux": check_elf, "windows": check_pe, "macos": check_macho}[system]
    exported, needed, facts = check(path)
    arch = said("llvm-readobj", "--file-headers", path)
    facts[processor] = bool(re.search({"x64": r"Arch: x86_64", "arm64": r"Arch: aarch64|Arch: arm64"}[processor], arch))
    ours = {name for name in exported if not re.fullmatch(SHOWN_ANYWAY.get(system, ""), name)}
    facts["exports the C interface and nothing else"] = ours == declared()
    facts["loads " + ", ".join(sorted(needed))] = all(re.fullmatch(LIBRARIES[system], name) for name in needed)
    for fact, holds in facts.items():
        print(f"{platform}: {fact}" + ("" if holds else "  WRONG"))
    if not all(facts.values()):
        sys.exit(1)


if __name__ == "__main__":
    main(*sys.argv[1:])
