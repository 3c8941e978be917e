"""The checks that cost next to nothing, which every render makes by itself."""

import logging

from ..bindings.session import Cancelled
from ..checks.check import check_snapshot
from ..checks.finding import shortened, told
from ..messages.messages import Messages


def quick_check(scene, snapshot, poll):
    """What F12 tells by itself, as Messages."""
    if not scene.lancer.use_check:
        return Messages()

    def obey(_share):
        if poll():
            raise Cancelled

    try:
        messages = Messages()
        for finding, left in shortened(check_snapshot(snapshot, thorough=False, poll=obey)):
            messages.add(told(finding, left), finding.key, finding.severity)
        return messages
    except Cancelled:
        raise
    except Exception as error:
        # A fault of the check must not cost the picture.
        logging.getLogger(__name__).exception("check failed")
        return Messages([f"scene '{scene.name}': the check before the render failed ({type(error).__name__}: {error})"])
