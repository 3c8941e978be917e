"""A process that answers requests, each within limits of time and memory; Ended has the reason of a failure."""

import contextlib
import json
import os
import select
import signal
import subprocess
import time

_STEP = 0.1


class Ended(Exception):
    """kind: "crash", "timeout" or "memory", which end the process, or "error", after which it still answers requests."""

    def __init__(self, kind, text):
        super().__init__(text)
        self.kind = kind


class Conversation:
    def __init__(self, command, log, environment=None):
        """command gets the number of the file descriptor of its answers as an argument. log: the file of its printed output."""
        self.answers, theirs = os.pipe()
        with open(log, "ab") as output:
            self.process = subprocess.Popen(
                [*map(str, command), str(theirs)],
                stdin=subprocess.PIPE,
                stdout=output,
                stderr=subprocess.STDOUT,
                pass_fds=[theirs],
                env=environment,
                start_new_session=True,
            )
        os.close(theirs)
        self._rest = b""

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self._end()
        os.close(self.answers)

    def ask(self, task, seconds, bytes_, **request):
        """Return the answer to a request; raises Ended, also if it takes more than the seconds or bytes of memory."""
        deadline = time.monotonic() + seconds
        try:
            self.process.stdin.write(json.dumps({"task": task, **request}).encode() + b"\n")
            self.process.stdin.flush()
        except BrokenPipeError:
            raise self._crash() from None
        while b"\n" not in self._rest:
            ready, _, _ = select.select([self.answers], [], [], _STEP)
            if ready:
                part = os.read(self.answers, 1 << 16)
                if not part:
                    raise self._crash()
                self._rest += part
                continue
            if time.monotonic() > deadline:
                self._end()
                raise Ended("timeout", f"not done after {seconds:.0f} s")
            if self._resident() > bytes_:
                self._end()
                raise Ended("memory", f"needs more than {bytes_ / 1e9:.1f} GB of memory")
        line, self._rest = self._rest.split(b"\n", 1)
        answer = json.loads(line)
        if "error" in answer:
            raise Ended("error", answer["error"])
        return answer

    def _resident(self):
        try:
            with open(f"/proc/{self.process.pid}/statm", encoding="ascii") as file:
                return int(file.read().split()[1]) * os.sysconf("SC_PAGE_SIZE")
        except (OSError, IndexError):
            # The process has just ended; the pipe will report it.
            return 0

    def _crash(self):
        code = self.process.wait()
        name = signal.Signals(-code).name if code < 0 else f"exit code {code}"
        return Ended("crash", f"ended by {name}")

    def _end(self):
        if self.process.poll() is None:
            # The process leads a session, so that its own child processes end with it.
            os.killpg(self.process.pid, signal.SIGKILL)
        self.process.wait()
        with contextlib.suppress(BrokenPipeError):
            self.process.stdin.close()
