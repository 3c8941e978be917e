"""What DaskPool asks of distributed's Client and Variable, answered by the simulated scheduler, and the client's own time."""

from collections import Counter
from concurrent.futures import CancelledError


class Ledger:
    """The client's time by what it does; spend() lets that much of it pass. Time in no entry is spent waiting."""

    def __init__(self, clock):
        self._clock = clock
        self.seconds = Counter()

    def spend(self, seconds, kind):
        self.seconds[kind] += seconds
        self._clock.advance(seconds)


class Future:
    def __init__(self, client, work):
        self._client, self.work, self.key = client, work, work.key

    @property
    def status(self):
        if not self.work.is_wanted:
            return "cancelled"
        return "finished" if self.work.is_told else "pending"

    def done(self):
        return self.status != "pending"

    def add_done_callback(self, act):
        if self.work.is_told:
            act(self)
        else:
            self.work.on_told.append(lambda: act(self))

    def result(self):
        return self._client.fetch(self.work)


class Client:
    """One thread: while it works or waits, the other machines go on."""

    dashboard_link = ""
    status = "running"

    def __init__(self, cluster, ledger, scene_bytes):
        self._cluster, self._ledger, self._scene_bytes = cluster, ledger, scene_bytes
        self._clock, self._costs, self._assumed = cluster.clock, cluster.costs, cluster.assumed
        self.fetched = self.parts = self.fetches = 0  # bytes and parts that have come, and requests for them
        ledger.spend(self._costs.connect_seconds, "submit")

    def submit(self, function, *arguments, key=None, priority=0, workers=None, pure=True, allow_other_workers=False):
        # The pool looks for workers that get no tasks.
        look = len(self._cluster.machines) * self._costs.list_seconds_per_worker
        self._ledger.spend(self._costs.submit.client + look, "submit")
        needs = [one.work for one in arguments if isinstance(one, Future)]
        work = self._cluster.submit(function.__name__, arguments, -priority, workers, needs)
        work.key = key or f"{function.__name__}-{work.number}"
        return Future(self, work)

    def fetch(self, work):
        """Return a result: ask the scheduler who has it, then that worker."""
        costs, assumed = self._costs, self._assumed
        self._ledger.spend(costs.fetch.client, "fetch")
        started = self._clock.now
        while True:
            self._wait_for([work])
            if not work.is_wanted:
                raise CancelledError(work.key)
            if assumed.in_turn:
                self._wait(lambda act: self._cluster.ask(costs.fetch.scheduler, act))
            source = self._cluster.holder(work)
            if source is not None:
                break
        if assumed.in_turn:
            self._clock.advance(2 * assumed.latency + costs.fetch.worker)
            self._wait(lambda act: source.send(work.nbytes, act, None))
        else:
            self._clock.advance(work.nbytes / assumed.bytes_per_second)
        self._have([work])
        self._ledger.seconds["wait for a part"] += self._clock.now - started
        return work.result

    def gather(self, futures, errors="raise", direct=None, asynchronous=None):
        """Return many results: ask the scheduler once, then all workers at once. errors: "skip" leaves cancelled ones out."""
        works, costs, assumed = [one.work for one in futures], self._costs, self._assumed
        self._ledger.spend(len(works) * costs.gather.client, "fetch")
        started = self._clock.now
        while True:
            self._wait_for(works)
            cancelled = [one.key for one in works if not one.is_wanted]
            if cancelled and errors == "raise":
                raise CancelledError(cancelled[0])
            works = [one for one in works if one.is_wanted]
            asking = len(works) * costs.gather.scheduler
            self._wait(lambda act, asking=asking: self._cluster.ask(asking, act))
            if all(self._cluster.holder(one) is not None for one in works):
                break
        # The client's link is the narrowest, as many workers send at once.
        nbytes = sum(one.nbytes for one in works)
        self._clock.advance(2 * assumed.latency + costs.gather.worker + nbytes / assumed.bytes_per_second)
        self._have(works)
        self._ledger.seconds["wait for a part"] += self._clock.now - started
        return [one.result for one in works]

    def _have(self, works):
        """Read the bytes that have come, which takes longer than a fast network, and let the workers forget them."""
        nbytes, costs = sum(one.nbytes for one in works), self._costs
        self._clock.advance(nbytes * max(0.0, costs.fetch_seconds_per_byte - 1.0 / self._assumed.bytes_per_second))
        self.fetched += nbytes
        parts = sum(one.nbytes > 0 for one in works)
        self.parts += parts
        self.fetches += parts > 0
        for work in works:
            self._cluster.forget(work)

    def scatter(self, data, workers, hash=True, direct=None):
        assumed = self._assumed
        self._ledger.spend(self._scene_bytes / assumed.bytes_per_second + 2 * assumed.latency, "scene")
        return Future(self, self._cluster.keep(self._scene_bytes, *workers))

    def nthreads(self):
        self._ask()
        return dict.fromkeys(self._cluster.machines, self._assumed.threads)

    def who_has(self, futures):
        self._ask()
        return {one.key: [machine.address for machine in one.work.holders] for one in futures}

    def processing(self):
        self._ask()
        return {address: [work.key for work in machine.assigned] for address, machine in self._cluster.machines.items()}

    def cancel(self, futures):
        self._ask()
        for one in futures:
            self._cluster.cancel(one.work)

    def close(self, timeout=None):
        pass

    def _ask(self):
        self._ledger.spend(self._costs.ask.client, "ask")
        self._wait(lambda act: self._cluster.ask(self._costs.ask.scheduler, act))

    def _wait_for(self, works):
        self._clock.wait(lambda: all(one.is_told or not one.is_wanted for one in works))

    def _wait(self, begin):
        """Let time pass until what begin(act) begins has called act."""
        ended = []
        begin(lambda: ended.append(True))
        self._clock.wait(lambda: ended)


def gathered(client, futures, look):
    """In place of dask_scheduler.gathered: results come without a look, as no scene is lost here."""
    return client.gather(futures) if len(futures) > 1 else [futures[0].result()]


class Variables:
    """In place of the class Variable. parcels: what the scheduler keeps by name."""

    def __init__(self, parcels):
        self._parcels = parcels

    def __call__(self, name, client=None):
        return _Variable(self._parcels, name)


class _Variable:
    def __init__(self, parcels, name):
        self._parcels, self.name = parcels, name

    def set(self, future):
        self._parcels[self.name] = future.work

    def delete(self):
        del self._parcels[self.name]
