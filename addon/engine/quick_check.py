"""The quick checks that every render runs."""

import logging

from ..bindings.session import Cancelled
from ..checks.check import check_snapshot
from ..checks.finding import shortened, told
from ..messages.messages import Messages


def quick_check(scene, snapshot, poll):
    """Return the findings of the quick checks as Messages; raise Cancelled by poll."""
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
        # An error in a check must not end the render.
        logging.getLogger(__name__).exception("check failed")
        return Messages([f"scene '{scene.name}': the check before the render failed ({type(error).__name__}: {error})"])
