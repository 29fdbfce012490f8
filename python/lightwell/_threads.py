"""A limit on the threads of the library."""

import contextlib
from typing import Iterator

from . import _lightwell
from ._arrays import whole_number


@contextlib.contextmanager
def thread_limit(count: int) -> Iterator[None]:
    """Limits all work of the library in this process to `count` threads, within a `with` block.

    Results do not depend on the number of threads.
    """
    limit = _lightwell.ThreadLimit(whole_number("count", count, 1, 1024))
    limit.enter()
    try:
        yield
    finally:
        limit.exit()
