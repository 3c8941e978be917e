"""Check of an ELF file before it is loaded.

The dynamic loader maps a truncated library without an error, and the process ends with SIGBUS at the first access to the
missing part.
"""

import os
import platform
import struct

_MACHINES = {"x86_64": 62, "amd64": 62, "aarch64": 183, "arm64": 183}


def fault(path):
    """Return the fault of the ELF file at path as the end of a sentence; None if it is complete and for this machine."""
    size = os.path.getsize(path)
    with open(path, "rb") as file:
        header = file.read(64)
    if len(header) < 64:
        return "is cut short"
    if header[:4] != b"\x7fELF":
        return "is not a shared library"
    if header[4] != 2 or header[5] != 1:
        return "is for another kind of processor"
    kind, machine = struct.unpack_from("<HH", header, 16)
    section_table = struct.unpack_from("<Q", header, 40)[0]
    section_size, section_count = struct.unpack_from("<HH", header, 58)
    if kind != 3:
        return "is not a shared library"
    if machine != _MACHINES.get(platform.machine().lower(), machine):
        return "is for another kind of processor"
    # Linkers write the section table last: a complete file reaches to its end.
    if section_table + section_size * section_count > size:
        return "is cut short"
    return None
