"""Generates the interface's numbers and structs in Python, and the core's table of parameters, from the C header.

    bindings.py         writes addon/bindings/enums.py and structs.py, core/src/scene/enums.h and
                        core/src/integrator/settings_table.h, from core/include/lancer.h and lancer_probes.h
    bindings.py FOLDER  writes all files into another folder

The parser relies on the plain style of the header: an enum is named lancer_something, or by the typedef on the line above it; a
struct has one kind of member on a line. Names follow by rule:
  - lancer_light_sample is LightSample; its docstring is the first sentence of the comment above it.
  - Members of an enum lose the words with which all members of that enum begin; ..._COUNT is no member.
  - An enum without 0 has bits, and is an IntFlag.
  - Where comments of members begin with [n], as those of passes do, n is the number of channels.
  - Where they begin with [kind number], as those of parameters do, these are the parameter's kind and default.
  - Where they begin with [kind number most], as those of settings may, most is the largest value.
  - A #define of a plain number is a constant.
"""

import re
import sys
import textwrap
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
HEADERS = [ROOT / "core" / "include" / name for name in ("lancer.h", "lancer_probes.h")]
FOLDER = ROOT / "addon" / "bindings"
CORE = ROOT / "core" / "src"
WIDTH = 128

HEAD = '''"""{what}

Generated from core/include/lancer.h by `make bindings`; changes here are lost.
"""
'''
NUMBERS = {"char": "c_char", "float": "c_float", "double": "c_double"} | {
    f"{sign}int{bits}_t": f"c_{sign}int{bits}" for sign in ("", "u") for bits in (8, 16, 32, 64)
}
COMMENT = r"(?:/\*(?P<comment>(?:(?!\*/).)*)\*/\n)?"
ENUM = re.compile(
    COMMENT + r"(?:typedef int32_t lancer_(?P<typedef>\w+);\n)?(?:typedef )?enum(?: lancer_(?P<name>\w+))? \{(?P<body>[^}]*)\}",
    re.DOTALL,
)
STRUCT = re.compile(COMMENT + r"typedef struct lancer_(?P<name>\w+) \{\n(?P<body>.*?)\n\} lancer_(?P=name);", re.DOTALL)
VALUE = re.compile(r"(LANCER_\w+)(?: = (\d+))?,?(?:\s*\[(\d)\])?")
PARAMETER = re.compile(r"lancer_parameter (?P<name>\w+); +/\* \[(?P<kind>\w+) (?P<default>[\d.]+)\]")
SETTING = re.compile(r"(?:uint32_t|float) (?P<name>\w+); +/\* \[(?P<kind>\w+) (?P<default>[\d.]+)(?: (?P<most>\d+))?\]")
CONSTANT = re.compile(r"#define LANCER_(\w+) (\d+)u")
# The enums that the core names as the interface does, and their names there.
CORE_ENUMS = {
    "ray": "RayKind",
    "node_kind": "NodeKind",
    "attribute_flag": "AttributeFlag",
    "color_model": "ColorModel",
    "object_fact": "ObjectFact",
    "path_fact": "PathFact",
    "noise_kind": "NoiseKind",
    "noise_flag": "NoiseFlag",
    "voronoi_feature": "VoronoiFeatureKind",
    "voronoi_metric": "VoronoiMetric",
    "voronoi_flag": "VoronoiFlag",
    "gradient_kind": "GradientKind",
    "profile": "Profile",
    "wave": "Wave",
    "space": "Space",
    "sky_model": "SkyModel",
    "coordinate": "Coordinate",
    "projection": "ImageProjection",
    "environment": "EnvironmentProjection",
    "mapping_type": "MappingType",
    "math_operation": "MathOperation",
    "vector_operation": "VectorOperation",
    "mix_mode": "MixMode",
    "material_flag": "MaterialFlag",
}
VECTORS = ("color", "direction", "vector")
MEMBER = re.compile(r"(?P<const>const )?(?P<type>\w+) (?P<names>[^;]+);")


def class_name(name):
    return "".join(word.capitalize() for word in name.split("_"))


def docstring(comment):
    """Returns the first sentence of a comment as the lines of a class docstring; no lines without a comment."""
    words = " ".join(re.sub(r"^ \* ?", "", line).strip() for line in (comment or "").splitlines())
    sentence = re.match(r"(.*?)[.:](?:\s|$)", words)
    if not sentence:
        return []
    first, *rest = textwrap.wrap(f'"""{sentence[1]}."""', WIDTH - 4)
    return [f"    {line}" for line in (first, *rest)] + [""]


def without_comments(text):
    """Returns the text without comments, except a leading [n]."""
    return re.sub(r"/\* (\[\d\])?.*?\*/", r"\1", text, flags=re.DOTALL)


def values(body):
    """Returns (name, value, channels) of an enum's members; a member without a number follows the previous one."""
    found, following = [], 0
    for name, value, channels in VALUE.findall(without_comments(body)):
        following = int(value) if value else following
        if not name.endswith("_COUNT"):
            found.append((name, following, int(channels or 0)))
        following += 1
    return found


def shortened(names):
    """Returns the names without their common leading words, as long as they remain valid in Python."""
    words = [name.split("_") for name in names]
    alike = 0
    while all(len(w) > alike + 1 and w[alike] == words[0][alike] and not w[alike + 1][0].isdigit() for w in words):
        alike += 1
    return ["_".join(w[alike:]) for w in words]


def enum_class(match):
    name = match["name"] or match["typedef"]
    if not name:
        sys.exit(f"An enum of lancer.h has no name: {match['body'].split()[0]}")
    members = values(match["body"])
    kind = "IntEnum" if any(value == 0 for _, value, _ in members) else "IntFlag"
    lines = [f"class {class_name(name)}({kind}):", *docstring(match["comment"])]
    names = shortened([long for long, _, _ in members])
    lines += [f"    {short} = {value}" for short, (_, value, _) in zip(names, members, strict=True)]
    channels = tuple(number for _, _, number in members)
    if any(channels):
        lines += ["", "    @property", "    def channels(self):", f"        return {channels}[self]"]
    return "\n".join(lines)


def field_type(member, length):
    """Returns the type in ctypes; pointers to numbers are arrays, passed as addresses."""
    kind = member["type"]
    if member["pointer"]:
        if kind == "char":
            return "c_char_p"
        return f"POINTER({class_name(kind.removeprefix('lancer_'))})" if kind.startswith("lancer_") else "Array"
    found = NUMBERS[kind] if kind in NUMBERS else class_name(kind.removeprefix("lancer_"))
    return f"{found} * {length}" if length else found


def fields(body):
    """Yields (name, type) of a struct's members."""
    for member in MEMBER.finditer(without_comments(body)):
        for item in member["names"].split(","):
            pointer, name, length = re.fullmatch(r"(\*?)(\w+)(?:\[(\d+)\])?", item.strip()).groups()
            yield name, field_type({"type": member["type"], "pointer": pointer}, length)


def struct_class(match):
    lines = [f"class {class_name(match['name'])}(Structure):", *docstring(match["comment"]), "    _fields_ = ["]
    lines += [f'        ("{name}", {kind}),' for name, kind in fields(match["body"])]
    return "\n".join([*lines, "    ]"])


def enums_text(header):
    constants = "\n".join(f"{name} = {value}" for name, value in CONSTANT.findall(header))
    classes = [enum_class(match) for match in ENUM.finditer(header)]
    head = HEAD.format(what="The numbers of the interface.")
    return "\n\n\n".join([f"{head}\nfrom enum import IntEnum, IntFlag\n\n{constants}", *classes]) + "\n"


def parameters(body):
    """Returns (name, kind, default) of a struct's parameters, as their comments state them."""
    return [(match["name"], match["kind"], float(match["default"])) for match in PARAMETER.finditer(body)]


def parameter_lines(name, body):
    """Returns the lines of a struct's parameters for Python."""
    lines = [f"    {class_name(name)}: {{"]
    for parameter, kind, default in parameters(body):
        value = f"({', '.join([str(default)] * 3)})" if kind in VECTORS else default
        lines.append(f'        "{parameter}": ("{kind}", {value}),')
    return [*lines, "    },"]


def table_text(header):
    """Returns the macro of the Principled BSDF's parameters for the core: kind, member, artists' name, default."""
    body = next(match["body"] for match in STRUCT.finditer(header) if match["name"] == "principled")
    rows = ["#define LANCER_PRINCIPLED_PARAMETERS(X)"]
    for name, kind, default in parameters(body):
        spoken = name.replace("_", " ").replace("color", "colour").replace("ior", "IOR")
        rows.append(f'  X({kind.capitalize()}, {name}, "{spoken}", {default}f)')
    return c_macro(rows)


def settings(header):
    """Returns (name, kind, default, most) of the members of lancer_settings, as their comments state them; most may be None."""
    body = next(match["body"] for match in STRUCT.finditer(header) if match["name"] == "settings")
    found = [match.group("name", "kind", "default", "most") for match in SETTING.finditer(body)]
    if [name for name, *_ in found] != [name for name, _ in fields(body)]:
        sys.exit("A member of lancer_settings lacks its [kind default] in the comment.")
    return found


def core_members(header, name):
    """Returns the wrapped lines of an enum's members for the core."""
    body = next(match["body"] for match in ENUM.finditer(header) if match["name"] == name)
    members = values(body)
    names = shortened([long for long, _, _ in members])
    listed = ", ".join(f"{class_name(short.lower())} = {value}" for short, (_, value, _) in zip(names, members, strict=True))
    return "\n".join(textwrap.wrap(listed, WIDTH, initial_indent="  ", subsequent_indent="  "))


def core_enums_text(header):
    """Returns the numbers of nodes, rays and materials, and the parameters of materials, for the core."""
    structs = "\n".join(
        f"struct {name} {{ enum : uint32_t {{\n{core_members(header, of)}\n}}; }};" for of, name in CORE_ENUMS.items()
    )
    return f"""// The numbers of the interface that records of a scene hold, and the parameters of lancer_principled:
// X(kind, member, name for artists, default).
// Generated from core/include/lancer.h by `make bindings`; changes here are lost.
#pragma once

#include <cstdint>

namespace lancer {{

// clang-format off
{structs}
// clang-format on

}} // namespace lancer

{table_text(header)}
"""


def settings_text(header):
    """Returns the settings for the core: kind, member, default, largest value."""
    rows = ["#define LANCER_SETTINGS(X)"]
    for name, kind, default, most in settings(header):
        given = f"{float(default)}f" if kind in ("amount", "width") else {"switch": "false"}.get(kind, f"{default}u")
        rows.append(f"  X({kind.capitalize()}, {name}, {given}, {most or '0xffffffff'}u)")
    return f"""// The passes, and the members of lancer_settings: X(kind, member, default, largest value).
// Generated from core/include/lancer.h by `make bindings`; changes here are lost.
#pragma once

#include <cstdint>

namespace lancer {{

// clang-format off
enum class Pass : uint32_t {{
{core_members(header, "pass")}
}};
// clang-format on

}} // namespace lancer

{c_macro(rows)}
"""


def c_macro(rows):
    """Returns the lines of a macro in the layout of clang-format."""
    return "".join(f"{row:<{WIDTH - 1}}\\\n" for row in rows[:-1]) + rows[-1]


def settings_lines(header):
    """Returns the lines of the settings for Python."""
    lines = ["# Kind and default of each setting, from lancer.h.", "SETTINGS = {"]
    for name, kind, default, _ in settings(header):
        value = {"amount": float, "width": float, "switch": lambda text: text != "0"}.get(kind, int)(default)
        lines.append(f'    "{name}": ("{kind}", {value}),')
    return [*lines, "}"]


def structs_text(header):
    found = {match["name"]: match for match in STRUCT.finditer(header)}
    listed = next(match for match in ENUM.finditer(header) if match["name"] == "struct")
    numbered = shortened([name for name, _, _ in values(listed["body"])])
    if {name.upper() for name in found} != set(numbered):
        sys.exit(f"lancer_struct and the structs of lancer.h differ: {sorted({n.upper() for n in found} ^ set(numbered))}")
    classes = [struct_class(match) for match in found.values()]
    described = [name for name, match in found.items() if parameters(match["body"])]
    for name in described:
        named = [member for member, kind in fields(found[name]["body"]) if kind == "Parameter"]
        if named != [parameter for parameter, *_ in parameters(found[name]["body"])]:
            sys.exit(f"A parameter of lancer_{name} lacks its [kind default] in the comment.")
    kinds = ["# Kind and default of each parameter, from lancer.h.", "PARAMETERS = {"]
    kinds += [line for name in described for line in parameter_lines(name, found[name]["body"])] + ["}"]
    names = set(re.findall(r"\bc_\w+", "\n".join(classes))) | {"c_void_p"}
    # The formatter's order: numbers within names by their value.
    used = sorted(names, key=lambda name: [int(part) if part.isdigit() else part for part in re.split(r"(\d+)", name)])
    head = [
        HEAD.format(what="The structs of the interface in ctypes, field by field."),
        f"from ctypes import POINTER, Structure, {', '.join(used)}\n",
        "from .enums import Struct\n",
        "# Arrays are passed as plain addresses, which numpy provides without a conversion for each element type.",
        "Array = c_void_p",
    ]
    table = ["STRUCTS = {", *(f"    Struct.{name}: {class_name(name)}," for name in numbered), "}"]
    return (
        "\n\n\n".join(["\n".join(head), *classes, "\n".join(table)])
        + "\n\n"
        + "\n".join([*kinds, "", *settings_lines(header)])
        + "\n"
    )


def main(folder=None):
    # Remove directives for the formatter, which separate comments from their declarations.
    text = re.sub(r"/\* clang-format \w+ \*/\n", "", "".join(header.read_text(encoding="utf-8") for header in HEADERS))
    for place, name, made in (
        (FOLDER, "enums.py", enums_text),
        (FOLDER, "structs.py", structs_text),
        (CORE / "scene", "enums.h", core_enums_text),
        (CORE / "integrator", "settings_table.h", settings_text),
    ):
        (Path(folder or place) / name).write_text(made(text), encoding="utf-8")


if __name__ == "__main__":
    main(*sys.argv[1:])
