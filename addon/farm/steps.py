"""Steps of a job and their tasks: commands whose arguments a form may write as variables of its own."""

import os
from dataclasses import dataclass

# What a value is for; a form decides by this whether a farm may replace it.
PROGRAM, INPUT, FOLDER, CODE, OF_TASK = "program", "input", "folder", "code", "of task"


@dataclass(frozen=True)
class Value:
    """An argument, or a part of one, that a form may write as a variable."""

    name: str
    kind: str
    about: str


@dataclass(frozen=True)
class Step:
    """Tasks that run one command. Each argument is a text, a Value, or a tuple of both, which are joined."""

    name: str
    arguments: tuple
    needs: tuple = ()  # names of the steps whose tasks must end before
    files_are_whole: bool = False  # a file that is there needs no further check by the command


@dataclass(frozen=True)
class Task:
    """One run of a step's command."""

    number: int  # in its job, from 1
    step: Step
    values: dict  # the text of each Value
    files: tuple  # that it makes
    needs: tuple = ()  # numbers of the tasks that must end before

    @property
    def arguments(self):
        return [joined(argument, self.values.get) for argument in self.step.arguments]

    @property
    def is_made(self):
        return all(map(is_made, self.files))


def is_made(file):
    """Whether a file is there and not empty."""
    return os.path.isfile(file) and os.path.getsize(file) > 0


def pieces(argument):
    return argument if isinstance(argument, tuple) else (argument,)


def joined(argument, value, constant=str, glue=""):
    """Return an argument as text, where value(Value) and constant(text) write its pieces."""
    return glue.join(value(piece) if isinstance(piece, Value) else constant(piece) for piece in pieces(argument))


def values_of(steps, *kinds):
    """Return the values of these kinds in the steps' commands, each once, in their order."""
    found = dict.fromkeys(piece for step in steps for argument in step.arguments for piece in pieces(argument))
    return [piece for piece in found if isinstance(piece, Value) and piece.kind in kinds]


def by_step(tasks):
    """Return {step: its tasks}, in the order of the tasks."""
    steps = {}
    for task in tasks:
        steps.setdefault(task.step, []).append(task)
    return steps
