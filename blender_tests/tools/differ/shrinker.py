"""The smallest scene that still fails: records and values are taken away one after the other. Knows nothing of Blender."""

from .record import Record, is_link


def shrink(records, fails, tell=lambda text: None):
    """fails(records) says whether the fault is still there. Gives a scene of which nothing more can be taken away alone."""
    records = list(records)
    size = None
    while size != _size(records):
        size = _size(records)
        for pass_ in (_without_chunks, _without_records, _with_short_cuts, _without_values):
            records = pass_(records, fails)
            tell(f"{len(records)} records, {_size(records)} values")
    return records


def _size(records):
    return sum(
        1 + len(record.fields) + sum(len(v) for v in record.fields.values() if isinstance(v, dict)) for record in records
    )


def _without_chunks(records, fails):
    """Halves, quarters, eighths at once."""
    length = len(records) // 2
    while length > 1:
        at = 0
        while at < len(records):
            fewer = records[:at] + records[at + length :]
            if len(fewer) and fails(fewer):
                records = fewer
            else:
                at += length
        length //= 2
    return records


def _without_records(records, fails):
    at = len(records) - 1
    while at >= 0:
        fewer = records[:at] + records[at + 1 :]
        if fails(fewer):
            records = fewer
        at -= 1
    return records


def _with_short_cuts(records, fails):
    """A node left out, with what one of its inputs is linked to in its place."""
    for record in list(records):
        if record.verb != "node" or record not in records:
            continue
        for source in [value for value in record.fields.get("inputs", {}).values() if is_link(value)]:
            shorter = [_relinked(other, f"@{record.name}", source) for other in records if other is not record]
            if fails(shorter):
                records = shorter
                break
    return records


def _relinked(record, name, source):
    inputs = record.fields.get("inputs")
    if record.verb != "node" or not inputs:
        return record
    inputs = {key: source if is_link(value) and value[0] == name else value for key, value in inputs.items()}
    return Record(record.verb, record.name, {**record.fields, "inputs": inputs})


def _without_values(records, fails):
    """Each field, each entry of a field that is a dict, and each member of a list of names but the last."""
    for at in range(len(records)):
        for key in list(records[at].fields):
            records = _attempt(records, at, fails, lambda fields, key=key: {k: v for k, v in fields.items() if k != key})
            value = records[at].fields.get(key)
            if isinstance(value, dict):
                for entry in list(value):
                    records = _attempt(
                        records, at, fails, lambda fields, key=key, entry=entry: _without_entry(fields, key, entry)
                    )
            elif isinstance(value, list) and len(value) > 1 and all(isinstance(item, str) for item in value):
                for item in list(value):
                    records = _attempt(records, at, fails, lambda fields, key=key, item=item: _without_item(fields, key, item))
    return records


def _attempt(records, at, fails, change):
    record = records[at]
    fewer = [*records[:at], Record(record.verb, record.name, change(record.fields)), *records[at + 1 :]]
    return fewer if fails(fewer) else records


def _without_entry(fields, key, entry):
    return {**fields, key: {k: v for k, v in fields[key].items() if k != entry}}


def _without_item(fields, key, item):
    return {**fields, key: [other for other in fields[key] if other != item] or fields[key]}
