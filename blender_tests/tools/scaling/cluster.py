"""A simulated scheduler of Dask: where it places work, in which order, and what each of its messages costs.

As distributed does without further settings: a worker of one thread gets a task and one in reserve, the others wait at the
scheduler, the most urgent first; a worker that is idle takes waiting work from others once a second; a lost worker's work
begins again. A task costs messages of its submission, assignment, end, announcement, release and forgetting.
"""

import heapq
import itertools
import random

from .clock import Server

# Messages of a task: submit, assign, end, announce, release, forget.
MESSAGES = 6
# Tasks that a worker of one thread has at most while others wait: distributed.scheduler.worker-saturation, rounded up.
_MOST = 2
# Seconds between two looks of a worker for a copy of the scene: dask_tasks.
_LOOK = 0.2
# Seconds between two searches for work that idle workers can take, and how many workers lose some of it: stealing.py.
_STEAL_EVERY, _VICTIMS = 1.0, 10


class Work:
    """A task of the scheduler. on_told: called when the client hears of its end."""

    def __init__(self, number, kind, arguments, priority, workers, needs):
        self.number, self.kind, self.arguments, self.priority = number, kind, arguments, priority
        self.key = None
        self.workers, self.needs = workers, needs
        self.followers = []
        self.is_wanted, self.is_made, self.is_told = True, False, False
        self.result, self.nbytes, self.holders = None, 0, []
        self.machine = None
        self.on_told = []


class Cluster:
    """machines: all Renderers; messages, works: how many so far."""

    def __init__(self, clock, costs, assumed, seed):
        self.clock, self.costs, self.assumed = clock, costs, assumed
        self.server = Server(clock)
        self.random = random.Random(seed)
        self.machines = {}
        self.messages = self.works = self.moved = self.lost = 0
        self.scene_came = 0.0  # seconds until the last machine had the scene
        self.parcels = {}  # works that are scenes, by the names of variables
        self._queue = []
        self._by_load = [{} for _ in range(_MOST)]  # machines with no task, and with one
        self._numbers = itertools.count()
        clock.after(_STEAL_EVERY, self._balance)

    def add(self, machine):
        self.machines[machine.address] = machine
        self._by_load[0][machine] = True

    def lose(self, machine):
        """End a machine, unless the scene would be lost with it; what was there is made again."""
        if any(kept.holders == [machine] for kept in self.parcels.values()):
            return
        self.lost += 1
        machine.is_alive = False
        del self.machines[machine.address]
        for load in self._by_load:
            load.pop(machine, None)
        for work in machine.has:
            if machine in work.holders:
                work.holders.remove(machine)
            is_used = work.followers and all(one.is_made for one in work.followers)
            if work.is_wanted and not work.holders and not is_used:
                self._make_again(work)
        assigned, machine.assigned = machine.assigned, {}
        for work in assigned:
            self._place(work)

    def _make_again(self, work):
        work.is_made = work.is_told = False
        for one in work.needs:
            if not one.holders:
                self._make_again(one)
        self._place_if_ready(work)

    def submit(self, kind, arguments, priority, workers, needs):
        work = Work(next(self._numbers), kind, arguments, priority, workers, needs)
        self.works += 1
        self.messages += MESSAGES

        def arrived():
            for one in needs:
                one.followers.append(work)
            self._place_if_ready(work)

        self._serve(0.5 * self.costs.submit.scheduler, arrived)
        return work

    def ask(self, seconds, act):
        """Call act() when the scheduler has answered a question that takes it that long."""
        self.messages += 2
        self._serve(seconds, lambda: self.clock.after(self.assumed.latency, act))

    def cancel(self, work):
        """Forget a task; one that has begun is done for nothing."""
        work.is_wanted = False
        if work.machine is not None and work in work.machine.assigned:
            self._unassign(work)

    def forget(self, work):
        """Free a result that the client has."""
        for machine in work.holders:
            machine.has.pop(work, None)
        work.holders.clear()
        self._serve(self.costs.release.scheduler, lambda: None)

    def done(self, machine, work, result, nbytes):
        """Called by a machine that has done some work."""

        def heard():
            if work in machine.assigned:
                self._unassign(work)
            if work.is_wanted and machine.is_alive:
                work.result, work.nbytes, work.is_made = result, nbytes, True
                work.holders.append(machine)
                self.clock.after(self.assumed.latency, lambda: self._tell(work))
                for one in work.followers:
                    self._place_if_ready(one)
            self._refill()

        self._serve(0.5 * self.costs.submit.scheduler, heard)

    def keep(self, nbytes, address):
        """Put bytes of the client to a machine; return them as work that is done."""
        work = Work(next(self._numbers), "data", (), 0, None, [])
        machine = self.machines[address]
        work.nbytes, work.is_made, work.machine = nbytes, True, machine
        work.holders.append(machine)
        machine.has[work] = True
        return work

    def holder(self, work):
        """Return a machine that has a result, and sends little else; None while nobody has it."""
        alive = [machine for machine in work.holders if machine.is_alive]
        return min(alive, key=lambda machine: machine.link.ends, default=None)

    def has_copy(self, work, machine):
        if machine not in work.holders:
            work.holders.append(machine)

    def fetch_parcel(self, parcel, machine, act):
        """Bring what a parcel names to a machine, which asks the scheduler where it is, and keeps no copy for others."""
        kept = self.parcels[parcel.choose(self.random)]
        self.messages += 4

        def found():
            source = self.holder(kept)
            if source is None:
                self.clock.after(_LOOK, found)
            else:
                source.send(kept.nbytes, act, None)

        self._serve(self.costs.scene.scheduler, lambda: self.clock.after(self.assumed.latency, found))

    def _serve(self, seconds, act):
        """Let a message come to the scheduler."""
        self.clock.after(self.assumed.latency, lambda: self.server.serve(seconds, act))

    def _tell(self, work):
        if work.is_wanted and not work.is_told:
            work.is_told = True
            for act in work.on_told:
                act()

    def _place_if_ready(self, work):
        if all(one.is_made for one in work.needs):
            self._place(work)

    def _place(self, work):
        if not work.is_wanted or work.is_made or work.machine is not None and work in work.machine.assigned:
            return
        if work.workers or work.needs:
            holders = [machine for one in work.needs for machine in one.holders]
            listed = [self.machines[one] for one in work.workers or () if one in self.machines]
            some = [machine for machine in holders if machine.is_alive and (not work.workers or machine in listed)]
            places = some or listed or list(self.machines.values())
            self._assign(work, min(places, key=lambda machine: len(machine.assigned)))
            return
        machine = next((machine for load in self._by_load for machine in load), None)
        if machine is None:
            heapq.heappush(self._queue, (work.priority, work.number, work))
        else:
            self._assign(work, machine)

    def _refill(self):
        while self._queue and (self._by_load[0] or self._by_load[1]):
            self._place(heapq.heappop(self._queue)[2])

    def _assign(self, work, machine):
        work.machine = machine
        machine.assigned[work] = True
        self._note(machine)
        self.clock.after(self.assumed.latency, lambda: machine.take(work))

    def _unassign(self, work):
        del work.machine.assigned[work]
        self._note(work.machine)

    def _note(self, machine):
        """Remember how many tasks a machine has."""
        for count, load in enumerate(self._by_load):
            if machine.is_alive and len(machine.assigned) == count:
                load[machine] = True
            else:
                load.pop(machine, None)

    def _balance(self):
        """Let idle machines take work that waits at others."""
        self.clock.after(_STEAL_EVERY, self._balance)
        idle = list(self._by_load[0])
        if not idle or len(idle) == len(self.machines):
            return
        loaded = sorted(self.machines.values(), key=lambda machine: -len(machine.assigned))
        mean = sum(len(machine.assigned) for machine in loaded) / len(loaded)
        # Dask's rule for workers that are saturated, with equal durations; without any, the ten with the most work lose some.
        saturated = [machine for machine in loaded if len(machine.assigned) >= _MOST and 1.0 > 1.9 * mean]
        for machine in saturated or loaded[:_VICTIMS]:
            waiting = [work for work in machine.assigned if work is not machine.running and not work.workers]
            for work in waiting[:1]:
                self.messages += 3
                if idle and machine.gives_up(work):
                    self.moved += 1
                    self._unassign(work)
                    self._assign(work, idle.pop())
