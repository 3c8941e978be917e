"""Texels of images in the order of LANCER_LAYOUT_BLOCKS, which the library reads in place."""

import numpy as np

SIDE = 64
# Least number of texels in the even sample of an image.
SAMPLED = 4096


class Blocks:
    """The texels of an image, in place of an array of rows; numpy.asarray() returns the rows.

    shape: (height, width, channels). file: a MappedFile, whose byte number offset is the first of the blocks. gaps: number of
    texels that are not finite. sample: the result of even_sample().
    """

    def __init__(self, shape, dtype, file, offset, gaps, sample):
        self.shape, self.dtype, self.file, self.gaps, self.sample = shape, np.dtype(dtype), file, gaps, sample
        self._offset = offset

    @property
    def array(self):
        """Return the blocks, (rows of blocks, blocks of a row, 64, 64, channels), in the file's memory."""
        height, width, channels = self.shape
        shape = -(-height // SIDE), -(-width // SIDE), SIDE, SIDE, channels
        return np.frombuffer(self.file.memory(), self.dtype, int(np.prod(shape, dtype=np.int64)), self._offset).reshape(shape)

    def equals(self, other):
        """Whether the texels are equal. Those of one place are not read; others are compared row by row of blocks."""
        if self.shape != other.shape or self.dtype != other.dtype:
            return False
        if self.file is other.file and self._offset == other._offset:
            return True
        is_float = self.dtype.kind == "f"
        return all(np.array_equal(*rows, equal_nan=is_float) for rows in zip(self.array, other.array, strict=True))

    def __array__(self, dtype=None, copy=None):
        width = self.shape[1]
        rows = np.empty(self.shape, self.dtype)
        for number, blocks in enumerate(self.array):
            part = rows[number * SIDE : (number + 1) * SIDE]
            part[...] = blocks.swapaxes(0, 1).reshape(SIDE, -1, self.shape[2])[: len(part), :width]
        return rows if dtype is None else rows.astype(dtype, copy=False)


def in_blocks(rows):
    """Yield rows of blocks, (blocks of a row, 64, 64, channels), of texels in rows. Texels beyond the image are 0."""
    height, width, channels = rows.shape
    across = -(-width // SIDE)
    for first in range(0, height, SIDE):
        part = rows[first : first + SIDE]
        padded = np.zeros((SIDE, across * SIDE, channels), rows.dtype)
        padded[: len(part), :width] = part
        yield np.ascontiguousarray(padded.reshape(SIDE, across, SIDE, channels).swapaxes(0, 1))


class Sampled:
    """The even sample of an image's texels, in place of all of them, for work that reads no others."""

    def __init__(self, texels):
        self.shape, self.dtype, self.sample = texels.shape, texels.dtype, even_sample(texels).copy()


def even_sample(texels):
    """Return every n-th texel of an image, (count, channels); count is at least SAMPLED if there are so many."""
    if isinstance(texels, (Blocks, Sampled)):
        return texels.sample
    texels = texels.reshape(-1, texels.shape[2])
    return texels[:: max(1, len(texels) // SAMPLED)]
