"""Messages about Cycles' settings of a scene that change its light and that Lancer does not follow.

One message reports all limits of Cycles' light paths that differ from Lancer's, another the pixel filter. Limits differ by
default: the message is a hint while all of Cycles' settings in it are Blender's defaults, and left out while Lancer's are, too.
Each other setting is reported if it differs from its default. Settings that change only noise and time are not read;
cycles_properties.py lists all settings.
"""

from ..messages.severity import Severity

_KINDS = ("diffuse", "glossy", "transmission")
_LIMITS = ("max_bounces", *(f"{kind}_bounces" for kind in _KINDS), "transparent_bounces", "clamp_indirect", "filter_glossy")


# A Gaussian of Cycles' width w has the standard deviation w / 4, its Blackman-Harris window 0.27702 w: at this share of the
# width both blur equally.
_GAUSSIAN_WIDTH = 0.25 / 0.27702
_FILTERS = {"BOX": "Box", "GAUSSIAN": "Gaussian", "BLACKMAN_HARRIS": "Blackman-Harris"}


def check_cycles(scene, messages):
    """Report a scene's settings."""
    # Cycles is an add-on and may be disabled.
    cycles = getattr(scene, "cycles", None)
    if cycles is None:
        return
    # The other integrators are not meant to match Cycles.
    if scene.lancer.integrator == "PATH":
        for text, severity in (*_light_paths(scene.lancer, cycles), *_pixel_filter(scene.lancer, cycles)):
            messages.add(f"scene '{scene.name}': {text}", severity=severity)
    for text in _light(cycles):
        messages.add(f"scene '{scene.name}': {text}")


def _light_paths(own, cycles):
    # (Setting, text) of each limit that Lancer does not apply.
    theirs = [("max_bounces", f"Total {cycles.max_bounces}")] if cycles.max_bounces != own.max_bounces else []
    # A limit of one kind has no effect if it is not below the limit of all bounces.
    deepest = min(cycles.max_bounces, own.max_bounces)
    ours = [f"Max Bounces {own.max_bounces}"]
    for kind in _KINDS:
        limit, here = (min(getattr(owner, f"{kind}_bounces"), deepest) for owner in (cycles, own))
        if limit != here:
            theirs.append((f"{kind}_bounces", f"{kind.capitalize()} {limit}"))
        if here < deepest:
            ours.append(f"{kind.capitalize()} {here}")
    # Cycles has one more than Lancer's largest number.
    layers = min(cycles.transparent_max_bounces, own.bl_rna.properties["transparent_bounces"].hard_max)
    if layers != own.transparent_bounces:
        theirs.append(("transparent_max_bounces", f"Transparent {layers}"))
    if cycles.blur_glossy > 0.0 and cycles.blur_glossy != own.filter_glossy:
        theirs.append(("blur_glossy", f"Filter Glossy {cycles.blur_glossy:g}"))
    if cycles.sample_clamp_indirect > 0.0 and cycles.sample_clamp_indirect != own.clamp_indirect:
        theirs.append(("sample_clamp_indirect", f"Clamp Indirect {cycles.sample_clamp_indirect:g}"))
    if layers != own.transparent_bounces:
        ours.append(f"Transparent {own.transparent_bounces}")
    if own.clamp_indirect > 0.0:
        ours.append(f"Clamp Indirect {own.clamp_indirect:g}")
    if own.filter_glossy > 0.0:
        ours.append(f"Filter Glossy {own.filter_glossy:g}")
    changed = any(_changed(cycles, name) for name, _ in theirs)
    # Leave out the limits of a new scene, which are defaults.
    if theirs and (changed or any(_changed(own, name) for name in _LIMITS)):
        told = _listed([words for _, words in theirs])
        severity = Severity.DIFFERENT if changed else Severity.HINT
        yield f"Cycles limits light by {told}, Lancer by {_listed(ours)}: set both alike for a comparison", severity


def filter_of(cycles):
    """Return Lancer's (pixel_filter, filter_width) for Cycles' pixel filter; the width is None if it has no effect."""
    kind = cycles.pixel_filter_type
    if kind == "BOX":
        return kind, None
    return "BLACKMAN_HARRIS", cycles.filter_width * (_GAUSSIAN_WIDTH if kind == "GAUSSIAN" else 1.0)


def _pixel_filter(own, cycles):
    kind, width = filter_of(cycles)
    # Single precision keeps seven digits of a width.
    if own.pixel_filter == kind and (width is None or abs(own.filter_width - width) <= 1e-5 * width):
        return
    theirs, ours = (
        f"{_FILTERS[name]}" + (f" {size:g}" if name != "BOX" else "")
        for name, size in ((cycles.pixel_filter_type, cycles.filter_width), (own.pixel_filter, own.filter_width))
    )
    changed = _changed(cycles, "pixel_filter_type") or _changed(cycles, "filter_width")
    yield (
        f"Cycles' pixel filter is {theirs}, Lancer's is {ours}: set Film alike to compare",
        Severity.DIFFERENT if changed else Severity.HINT,
    )


def _listed(words):
    return " and ".join(filter(None, (", ".join(words[:-1]), words[-1])))


def _light(cycles):
    if getattr(cycles, "use_pixel_jitter", False):
        yield "Cycles' Pixel Jitter is not supported, samples are spread over the pixel"


def _changed(owner, name):
    """Whether a setting differs from its default."""
    return getattr(owner, name) != owner.bl_rna.properties[name].default
