"""Images in blocks: the same records, files and digests as in rows; pages of their file stay under the limit."""

import io
import mmap
import sys
import tempfile

import numpy as np
import pytest

from addon.bindings.blocks import SAMPLED, Blocks, even_sample, in_blocks
from addon.bindings.digest import scene_digest
from addon.bindings.mapped_file import MappedFile, MappedPages, _bytes_of_files
from addon.bindings.record import same
from addon.bindings.snapshot import Image, SceneSnapshot

SPARE = np.zeros(4096, np.uint8)


def blocks_of(*images, limit=1 << 30):
    """Return Blocks of arrays of rows, all in one file."""
    file, made = MappedFile(tempfile.TemporaryFile(), limit), []
    for rows in images:
        offset = file.size
        for blocks in in_blocks(rows):
            file.write(blocks)
        file.write(SPARE)
        made.append(Blocks(rows.shape, rows.dtype, file, offset, 0, even_sample(rows)))
    return made


def texels(*shape, dtype=np.uint8):
    return np.random.default_rng(shape).integers(0, 256, shape).astype(dtype)


@pytest.mark.parametrize("shape", [(1, 1, 1), (63, 64, 3), (64, 65, 4), (130, 63, 4), (65, 200, 1)])
@pytest.mark.parametrize("dtype", [np.uint8, np.uint16, np.float32])
def test_rows_come_back(shape, dtype):
    rows = texels(*shape, dtype=dtype)
    other, found = blocks_of(texels(3, 5, 3), rows)
    assert np.array_equal(np.asarray(found), rows) and np.asarray(found).dtype == dtype
    height, width, _ = shape
    for y, x in ((0, 0), (height - 1, width - 1), (height // 2, width // 3)):
        assert np.array_equal(found.array[y // 64, x // 64, y % 64, x % 64], rows[y, x])
    assert found.array.ctypes.data % 4096 == 0 and np.array_equal(np.asarray(other), texels(3, 5, 3))


def test_a_sample_reads_no_block():
    rows = texels(200, 300, 3)
    (found,) = blocks_of(rows)
    assert np.array_equal(even_sample(found), rows.reshape(-1, 3)[:: 200 * 300 // SAMPLED])
    assert not found.file.is_mapped


def test_records_are_those_of_rows():
    rows = texels(70, 90, 4)
    plain = Image("picture", rows)
    (found,) = blocks_of(rows)
    blocked = plain.replaced(texels=found)
    assert blocked == plain and Image("picture", found) == plain != Image("picture", rows + 1)
    scenes = [SceneSnapshot(images=(picture,)) for picture in (plain, blocked)]
    assert scene_digest(scenes[0]) == scene_digest(scenes[1])
    file = io.BytesIO()
    scenes[1].save(file)
    file.seek(0)
    loaded = SceneSnapshot.load(file)
    assert loaded == scenes[0] and isinstance(loaded.images[0].texels, np.ndarray)


@pytest.mark.skipif(sys.platform != "linux", reason="only Linux lets go of single pages of a mapped file")
def test_pages_stay_under_the_limit():
    rows = texels(1024, 4096, 4)
    (found,) = blocks_of(rows, limit=rows.nbytes // 2)
    pages = MappedPages()
    pages.add(found.file)
    before = _bytes_of_files()
    total = int(found.array.view(np.uint32).sum(dtype=np.uint64))
    # The kernel counts pages of other threads' files, too, in batches of at most 64 on each processor.
    slack = 64 * mmap.PAGESIZE * 2
    assert _bytes_of_files() - before > rows.nbytes - slack
    pages.keep_under()
    assert _bytes_of_files() - before <= rows.nbytes // 2 + slack
    assert total == int(rows.view(np.uint32).sum(dtype=np.uint64)) and np.array_equal(np.asarray(found), rows)


@pytest.mark.parametrize("dtype", [np.uint8, np.float32])
def test_blocks_are_compared_in_place(dtype, monkeypatch):
    rows = texels(130, 70, 3, dtype=dtype)
    other = rows.copy()
    other[-1, -1, 2] += 1
    if dtype == np.float32:
        rows[0, 0, 0] = other[0, 0, 0] = np.nan
    one, different, again = blocks_of(rows, other, rows)
    monkeypatch.setattr(Blocks, "__array__", None)
    assert same(one, again) and not same(one, different) and not same(one, blocks_of(rows[:-1])[0])
    twin = Blocks(one.shape, one.dtype, one.file, one._offset, 0, one.sample)
    monkeypatch.setattr(Blocks, "array", None)
    assert same(one, twin)
