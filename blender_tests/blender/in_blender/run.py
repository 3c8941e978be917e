"""Runs cases inside a Blender, the module or the program: ... run.py -- ANSWERS.

Each line of the standard input is a request: file, function and arguments of a case, the folder that it runs in, the file of
its result and the file that its output goes to. The exit code of each case is written to the file descriptor ANSWERS. Every
case starts from Blender's factory settings, and with the project's modules imported anew.
"""

import ctypes
import gc
import importlib
import json
import os
import sys
import traceback

import bpy

HERE = os.path.dirname(os.path.abspath(__file__))
TESTS = os.path.dirname(os.path.dirname(HERE))
ROOT = os.path.dirname(TESTS)
sys.path[:0] = [ROOT, HERE]
sys.path += [TESTS, os.path.join(TESTS, "helpers")]


def handlers():
    found = {name: getattr(bpy.app.handlers, name) for name in dir(bpy.app.handlers)}
    return {name: functions for name, functions in found.items() if isinstance(functions, list)}


# The environment of Python may lie in the project, too.
OURS = tuple(os.path.join(ROOT, folder, "") for folder in ("addon", "blender_tests", "scenes"))
ENVIRONMENT = dict(os.environ)
PATH = list(sys.path)
HANDLERS = {name: list(found) for name, found in handlers().items()}


def flush():
    """Blender's C++ has a buffer of its own."""
    sys.stdout.flush()
    sys.stderr.flush()
    ctypes.CDLL(None).fflush(None)


def redirect(path):
    flush()
    file = os.open(path, os.O_WRONLY | os.O_CREAT | os.O_APPEND)
    os.dup2(file, 1)
    os.dup2(file, 2)
    os.close(file)


def is_ours(module):
    return (getattr(module, "__file__", None) or "").startswith(OURS) and module.__name__ != "__main__"


def reset():
    """Factory settings; no module of the project, no handler, path or variable of the case before."""
    for name, module in list(sys.modules.items()):
        if is_ours(module):
            del sys.modules[name]
    sys.path[:] = PATH
    os.environ.clear()
    os.environ.update(ENVIRONMENT)
    for name, functions in handlers().items():
        functions[:] = HANDLERS.get(name, [])
    bpy.ops.wm.read_factory_settings()
    gc.collect()


def run(where, name, arguments, result):
    from invalid_samples import watched

    import addon
    from addon.bindings.session import Session

    addon.register()
    case = getattr(importlib.import_module(where), name)
    with watched(Session) as found:
        value = case(*arguments)
    # No render of any case may drop a sample, unless the case declares that it does.
    if found and not getattr(case, "overflows", False):
        raise AssertionError(f"{where}.{name}: {found}")
    with open(result, "w", encoding="utf-8") as file:
        json.dump(value, file)
    addon.unregister()


def answer(folder, log, environment, **case):
    """Returns the case's exit code."""
    redirect(log)
    try:
        reset()
        os.chdir(folder)
        os.environ.update(environment)
        run(**case)
        return 0
    except BaseException:
        traceback.print_exc()
        return 1
    finally:
        flush()


if __name__ == "__main__":
    answers = int(sys.argv[-1])
    for line in sys.stdin:
        os.write(answers, b"%d\n" % answer(**json.loads(line)))
