"""Exceptions of the package. Each message is a sentence: what is wrong, where, and what to do."""


class Error(RuntimeError):
    """Lightwell could not do what was asked."""


class InputError(Error, ValueError):
    """Wrong input: a file, an array, a name or a value."""


class Interrupted(Error):
    """The progress callback returned False, so the work was stopped."""
