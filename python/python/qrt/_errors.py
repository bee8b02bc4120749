"""The exceptions and warnings of qrt."""

from __future__ import annotations

from typing import NamedTuple


class Problem(NamedTuple):
    """One thing that is wrong with a scene.

    `code` stays the same from version to version; `line` and `column` count from 1, columns in
    characters, and are None where a file could not be read; `help` says what to write instead, or is
    None.
    """

    code: str
    message: str
    file: str
    line: int | None
    column: int | None
    help: str | None


class Error(Exception):
    """Any error of qrt. `problems` has one entry for each thing that is wrong with a scene, and none where
    it is not the scene that is wrong."""

    problems: tuple[Problem, ...] = ()


class SceneError(Error, ValueError):
    """A scene is wrong. Its text is what the command `qrt` shows; `problems` has one entry for each
    thing that is wrong, in the order of their places."""

    def __init__(self, text: str, problems: tuple[Problem, ...] = ()):
        super().__init__(text)
        self.problems = tuple(problems)

    def __str__(self) -> str:
        return str(self.args[0])

    def __reduce__(self) -> tuple[type, tuple[str, tuple[Problem, ...]]]:
        return type(self), (str(self), self.problems)


class RequestError(Error, ValueError):
    """A request that names what does not exist, or combines what does not go together."""


class JobError(Error, RuntimeError):
    """The work failed: another attempt may not."""


class MergeError(Error, ValueError):
    """Parts of a picture that do not make one: a part is missing, there twice, damaged, or of another
    picture."""


class SceneWarning(UserWarning):
    """Something in a scene that is not wrong, but surely not meant."""
