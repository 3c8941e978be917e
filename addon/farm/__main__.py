"""Commands for pictures without Blender: `lancer COMMAND`, or `python -m lancer.farm COMMAND`."""

import argparse
import sys
from pathlib import Path

from ..bindings.abi import LancerError
from ..bindings.session import Cancelled
from . import frames_command, parts_command, render_command
from .arguments import threads
from .exit_codes import DONE, FAILED, WRONG_USE, WrongUse
from .pool import PoolError


def parser():
    top = argparse.ArgumentParser(prog="lancer", description=__doc__)
    commands = top.add_subparsers(metavar="COMMAND", required=True)
    render_command.add_parser(commands)
    parts_command.add_parsers(commands)
    frames_command.add_parser(commands)
    worker = commands.add_parser("worker", help="work for a scheduler with all processors of this machine")
    worker.add_argument("address", help="of a Dask scheduler, as tcp://host:8786")
    worker.add_argument("--threads", type=threads, default=0, help="of a render; default: one per processor")
    worker.set_defaults(run=_work)
    relay = commands.add_parser("relay", help="speak to a scheduler for Blender")
    relay.add_argument("address")
    relay.set_defaults(run=_relay)
    return top, commands


def main(arguments=None):
    """Run a command and return its exit code."""
    given = list(sys.argv[1:] if arguments is None else arguments)
    top, commands = parser()
    # The most usual command needs no name.
    if given and given[0] not in commands.choices and Path(given[0]).suffix in (".npz", ".zip"):
        given.insert(0, "render")
    chosen = top.parse_args(given)
    try:
        return chosen.run(chosen) or DONE
    except WrongUse as error:
        return _end(error, WRONG_USE)
    except MemoryError:
        return _end("there is not enough memory for this scene", FAILED)
    except (LancerError, PoolError, OSError) as error:
        return _end(error, FAILED)
    except (Cancelled, KeyboardInterrupt):
        return _end("interrupted", FAILED)


def _end(text, code):
    sys.stderr.write(f"lancer: {text}\n")
    return code


def _work(arguments):
    from .dask_worker import work

    return work(arguments.address, arguments.threads)


def _relay(arguments):
    from .relay import relay

    return relay(arguments.address)


if __name__ == "__main__":
    sys.exit(main())
