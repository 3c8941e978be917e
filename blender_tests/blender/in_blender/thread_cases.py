"""Work that another thread requests from the main thread; the case calls the function of the window's timer itself."""

import os
import tempfile
import threading
import time

import bpy
from image_cases import ramp, write

from addon.bindings.session import Cancelled
from addon.export import image_sources
from addon.export.images import Images
from addon.host import main_thread


class _Asker(threading.Thread):
    """Requests work from its own thread; outcome is the result, or the error's name."""

    def __init__(self, work, obey=None):
        super().__init__()
        self.work, self.obey, self.outcome = work, obey, None
        self.start()

    def run(self):
        try:
            with main_thread.obeying(self.obey):
                self.outcome = main_thread.run(self.work)
        except Exception as error:
            self.outcome = type(error).__name__


def _who():
    return threading.current_thread() is threading.main_thread()


def asked():
    """Return the outcome of each kind of work, and the thread that did it."""
    result = {"here": main_thread.run(_who)}
    main_thread._serving = True
    done = []

    def serve(asker):
        # Serve as the window's timer does; the pause lets the requesting thread run in between.
        while asker.is_alive():
            main_thread.serve()
            time.sleep(0.01)
        return asker.outcome

    result["by main"] = serve(_Asker(_who))
    result["error"] = serve(_Asker(lambda: 1 / 0))
    looks = []

    def obey():
        looks.append(1)
        if len(looks) > 3:
            raise Cancelled

    # Without a main loop only the user's Esc ends the wait, and the requested work is never done.
    asker = _Asker(lambda: done.append("cancelled"), obey)
    asker.join()
    main_thread.serve()
    result["cancelled"] = asker.outcome
    poster = threading.Thread(target=main_thread.post, args=(lambda: done.append("posted"),))
    poster.start()
    poster.join()
    result["before"] = list(done)
    main_thread.serve()
    result["done"] = done
    main_thread._serving = False
    return result


def stopped():
    """Return how many of nine tiles are read if the user cancels after the third, and the error that ends the reading."""
    folder = tempfile.mkdtemp()
    for number in range(1001, 1010):
        write(os.path.join(folder, f"tile.{number}.png"), ramp(3))
    image = bpy.data.images.load(os.path.join(folder, "tile.1001.png"))
    image.source, image.filepath = "TILED", os.path.join(folder, "tile.<UDIM>.png")
    known = [tile.number for tile in image.tiles]
    for number in range(1001, 1010):
        if number not in known:
            image.tiles.new(number)
    read, read_texels = [], image_sources.read_texels

    def counted(*arguments):
        read.append(1)
        return read_texels(*arguments)

    def obey():
        if len(read) == 3:
            raise Cancelled

    image_sources.read_texels = counted
    try:
        Images(obey).numbers(image, None, lambda text: None)
        end = "read"
    except Cancelled:
        end = "cancelled"
    image_sources.read_texels = read_texels
    return {"tiles": len(read), "end": end}
