"""no_op ADDRESS COUNT: workers of Dask that render nothing, so that what remains is the cost of Dask itself.

All workers are in this process. A part has as many bytes as the number of lights of a sample says.
"""

import asyncio
import contextlib
import sys
import tempfile

import dask
import numpy as np
from distributed import Worker

from addon.farm import dask_worker, worker


def _render(name, data, splits, ranges, threads=0, address=""):
    return worker.Made(np.zeros(splits[0], np.uint8), 1e-3, (address,), "none")


def _prepare(name, data, threads=0):
    data()


def _decide(name, data, threads=0):
    data()
    return worker.Decision(1, 1, (), {"instruction_set": "none"})


async def main(address, count):
    worker.render, worker.prepare, worker.decide = _render, _prepare, _decide
    dask.config.set(dask_worker._QUIET)
    async with contextlib.AsyncExitStack() as stack:
        folder = stack.enter_context(tempfile.TemporaryDirectory())
        made = [
            await stack.enter_async_context(Worker(address, nthreads=1, local_directory=folder, dashboard=False))
            for _ in range(count)
        ]
        await asyncio.gather(*(one.finished() for one in made))


if __name__ == "__main__":
    asyncio.run(main(sys.argv[1], int(sys.argv[2])))
